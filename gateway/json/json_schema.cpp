#include "gateway/json/json_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "gateway/json/schema_words.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxProblems = 6;

/// valijson's context ("<root>", "[Joints]", "[0]") as steps of a pointer.
std::vector<std::string> steps_of(const std::vector<std::string>& context) {
  std::vector<std::string> steps;
  for (const std::string& part : context) {
    if (part.size() >= 2 && part.front() == '[') steps.push_back(part.substr(1, part.size() - 2));
  }
  return steps;
}

/// The name that valijson puts between quotes after `anchor`.
std::string quoted_name(const std::string& message, std::string_view anchor) {
  const auto begin = message.find(anchor);
  const auto end = message.rfind('\'');
  if (begin == std::string::npos || end < begin + anchor.size()) return {};
  return message.substr(begin + anchor.size(), end - begin - anchor.size());
}

const Json* value_at(const Json& document, const std::vector<std::string>& steps) {
  const Json* value = &document;
  for (const std::string& step : steps) {
    if (value->is_object() && value->contains(step)) {
      value = &value->at(step);
    } else if (value->is_array() && std::stoul(step) < value->size()) {
      value = &value->at(std::stoul(step));
    } else {
      return nullptr;
    }
  }
  return value;
}

}  // namespace

struct JsonSchema::Impl {
  Json text;
  valijson::Schema compiled;

  /// What one of valijson's findings means, or nothing when it only repeats one that lies deeper.
  [[nodiscard]] std::string explain(const Json& document, const valijson::ValidationResults::Error& error) const {
    if (error.description.starts_with("Failed to validate")) return {};
    const std::vector<std::string> steps = steps_of(error.context);
    const SchemaWords words(text);
    const Json& wanted = words.at(steps);
    const std::string place = steps.empty() ? "the document" : fmt::format("/{}", fmt::join(steps, "/"));
    if (error.description.starts_with("Missing required")) {
      const std::string key = quoted_name(error.description, "property '");
      return fmt::format("{} lacks the key \"{}\", {}", place, key, words.allowed(words.property(wanted, key)));
    }
    if (error.description.starts_with("Object contains a property")) {
      const std::string key = quoted_name(error.description, "constraints: '");
      return fmt::format("{} has the unknown key \"{}\"; {}", place, key, words.known_keys(wanted, key));
    }
    const Json* value = value_at(document, steps);
    return fmt::format("{} is {}; allowed is {}", place, value == nullptr ? "wrong" : SchemaWords::shown(*value),
                       words.allowed(wanted));
  }
};

JsonSchema::JsonSchema(std::string_view text) : impl_(std::make_unique<Impl>()) {
  impl_->text = Json::parse(text);
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(impl_->text), impl_->compiled);
}

JsonSchema::~JsonSchema() = default;

std::string JsonSchema::check(const Json& document) const {
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(impl_->compiled, valijson::adapters::NlohmannJsonAdapter(document), &results)) return {};

  std::vector<std::string> problems;
  std::set<std::string> seen;
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    std::string problem = impl_->explain(document, error);
    if (!problem.empty() && seen.insert(problem).second) problems.push_back(std::move(problem));
  }
  if (problems.empty()) return "the document does not fit its schema";
  if (problems.size() > kMaxProblems) {
    const std::size_t more = problems.size() - kMaxProblems;
    problems.resize(kMaxProblems);
    problems.push_back(fmt::format("and {} more", more));
  }
  return fmt::format("{}", fmt::join(problems, "; "));
}

}  // namespace rmac::gateway
