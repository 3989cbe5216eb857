#include "gateway/json/schema_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

const Json& nothing() {
  static const Json kNothing = Json::object();
  return kNothing;
}

std::string number(const Json& value) {
  return fmt::format("{}", value.get<double>());
}

/// The bounds of a number: "above 0, at most 10", "from 1 to 5".
std::string range(const Json& schema) {
  if (schema.contains("minimum") && schema.contains("maximum")) {
    return fmt::format(" from {} to {}", number(schema["minimum"]), number(schema["maximum"]));
  }
  std::string text;
  if (schema.contains("exclusiveMinimum")) text += " above " + number(schema["exclusiveMinimum"]);
  if (schema.contains("minimum")) text += " of at least " + number(schema["minimum"]);
  if (schema.contains("maximum"))
    text += (text.empty() ? " of" : " and") + std::string(" at most ") + number(schema["maximum"]);
  return text;
}

std::string sizes(const Json& schema, const char* least, const char* most) {
  if (schema.contains(least) && schema.contains(most)) {
    return fmt::format("{} to {}", schema[least].dump(), schema[most].dump());
  }
  return schema.contains(most) ? "at most " + schema[most].dump() : "any number of";
}

/// Levenshtein's distance, to guess which key was meant.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::size_t> likely_meant(std::span<const std::string> known, std::string_view mistyped) {
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(a, mistyped) < edit_distance(b, mistyped);
  });
  if (nearest == known.end() || edit_distance(*nearest, mistyped) > 1 + mistyped.size() / 4) return std::nullopt;
  return static_cast<std::size_t>(nearest - known.begin());
}

const Json& SchemaWords::resolved(const Json& schema) const {
  const Json* current = &schema;
  while (current->contains("$ref")) {
    const auto target = (*current)["$ref"].get<std::string>().substr(1);
    current = &root_.at(Json::json_pointer(target));
  }
  return *current;
}

const Json& SchemaWords::property(const Json& object_schema, const std::string& key) const {
  const Json& schema = resolved(object_schema);
  if (schema.contains("properties") && schema["properties"].contains(key)) return resolved(schema["properties"][key]);
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    return resolved(schema["additionalProperties"]);
  }
  return nothing();
}

const Json& SchemaWords::at(const std::vector<std::string>& steps) const {
  const Json* schema = &root_;
  for (const std::string& step : steps) {
    const Json& current = resolved(*schema);
    schema = current.contains("items") ? &resolved(current["items"]) : &property(current, step);
  }
  return resolved(*schema);
}

std::string SchemaWords::allowed(const Json& unresolved) const {
  const Json& schema = resolved(unresolved);
  const std::string unit = schema.contains("x-unit") ? fmt::format(" ({})", schema["x-unit"].get<std::string>()) : "";
  if (schema.contains("not")) return schema.value("x-form", "something else");
  if (schema.contains("enum")) {
    std::vector<std::string> choices;
    for (const Json& choice : schema["enum"]) choices.push_back(choice.dump());
    return fmt::format("one of {}", fmt::join(choices, ", "));
  }
  const Json type = schema.value("type", Json());
  if (type.is_array()) return schema.value("x-form", "a value of another type");
  if (type == "boolean") return "true or false";
  if (type == "integer") return fmt::format("an integer{}{}", range(schema), unit);
  if (type == "number") return fmt::format("a number{}{}", range(schema), unit);
  if (type == "array") return fmt::format("an array of {} entries", sizes(schema, "minItems", "maxItems"));
  if (type == "string") {
    const std::string form = schema.contains("x-form") ? fmt::format(" ({})", schema["x-form"].get<std::string>()) : "";
    if (!schema.contains("maxLength")) return "a text" + form;
    return fmt::format("a text of {} characters{}", sizes(schema, "minLength", "maxLength"), form);
  }
  if (type == "object") {
    return schema.contains("maxProperties")
               ? fmt::format("an object of at most {} keys", schema["maxProperties"].dump())
               : "an object";
  }
  return "something else";
}

std::string SchemaWords::known_keys(const Json& object_schema, std::string_view key) const {
  const Json& schema = resolved(object_schema);
  std::vector<std::string> keys;
  const Json properties = schema.value("properties", Json::object());
  for (const auto& [name, unused] : properties.items()) keys.push_back(name);
  const auto meant = likely_meant(keys, key);
  return fmt::format("{}allowed are {}", meant ? fmt::format("did you mean \"{}\"? ", keys[*meant]) : "",
                     fmt::join(keys, ", "));
}

std::string SchemaWords::shown(const Json& value) {
  if (value.is_array()) return fmt::format("an array of {} entries", value.size());
  if (value.is_object()) return fmt::format("an object of {} keys", value.size());
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= kLongest) return text;
  return fmt::format("{}… ({} bytes)", text.substr(0, kLongest), text.size());
}

}  // namespace rmac::gateway
