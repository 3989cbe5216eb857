#include "gateway/collision/setup/setup.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/bodies/body_json.hpp"
#include "gateway/json/json_document.hpp"
#include "gateway/json/printable.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

const JsonSchema& schema() {
  static const JsonSchema kSchema(setup_schema_text());
  return kSchema;
}

Expected<> read_bodies(const Json& document, const MeshFolder& folder, Setup& setup) {
  const auto one = [&](const char* key, const char* name, std::optional<Body>& body) -> Expected<> {
    if (!document.contains(key)) return {};
    auto read = read_body(document[key], fmt::format("/{}", key), folder);
    if (!read) return tl::unexpected(read.error());
    body = std::move(*read);
    body->name = name;
    return {};
  };
  if (auto read = one("Stock", "stock", setup.stock); !read) return read;
  if (auto read = one("Part", "part", setup.part); !read) return read;
  const Json fixtures = document.value("Fixtures", Json::array());
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    const std::string pointer = fmt::format("/Fixtures/{}", i);
    auto read = read_body(fixtures[i], pointer, folder);
    if (!read) return tl::unexpected(read.error());
    for (const Body& other : setup.fixtures) {
      if (other.name != read->name) continue;
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("{}/Name is \"{}\", which another fixture has; give it its own", pointer, read->name));
    }
    setup.fixtures.push_back(std::move(*read));
  }
  return {};
}

/// Of a document that the schema has passed.
Expected<Setup> fill(const Json& document, const MeshFolder& folder) {
  Setup setup;
  setup.machine = document["Machine"];
  setup.material = document.value("Material", "");
  setup.clearance_mm = document.value("Clearance", setup.clearance_mm);
  setup.tolerance_mm = document.value("Tolerance", setup.tolerance_mm);
  if (document.contains("Resolution")) setup.resolution_mm = document["Resolution"].get<double>();
  if (document.contains("PartFrame")) {
    auto frame = read_frame(document["PartFrame"], "/PartFrame");
    if (!frame) return tl::unexpected(frame.error());
    setup.part_frame = *frame;
  }
  return read_bodies(document, folder, setup).map([&] { return std::move(setup); });
}

/// Where a text stands that is longer than any that a set-up has: patterns are not tried on it.
std::optional<std::string> long_text(const Json& value, int depth = 0) {
  constexpr std::size_t kLongest = 4096;
  constexpr int kDeepest = 8;
  if (value.is_string()) {
    return value.get_ref<const std::string&>().size() > kLongest ? std::optional(std::string()) : std::nullopt;
  }
  if (!value.is_structured() || depth > kDeepest) return std::nullopt;
  for (const auto& [key, entry] : value.items()) {
    if (const auto below = long_text(entry, depth + 1)) return fmt::format("/{}{}", key, *below);
  }
  return std::nullopt;
}

tl::unexpected<Error> wrong(const std::string& what) {
  constexpr std::size_t kLongestMessage = 1000;
  return failure(MinorCode::InvalidParameterValue, printable(what, kLongestMessage));
}

}  // namespace

Expected<Setup> read_setup(const std::filesystem::path& file) {
  const auto document = read_json_document(file, schema());
  if (!document) return tl::unexpected(document.error());
  auto setup = fill(*document, file.parent_path());
  if (setup) return setup;
  return failure(setup.error().code, fmt::format("{}: {}", file.string(), setup.error().message));
}

Expected<Setup> read_setup_object(const Json& document) {
  if (const auto text = long_text(document)) return wrong(*text + " is longer than any text that a set-up has");
  if (const std::string problems = schema().check(document); !problems.empty()) return wrong(problems);
  auto setup = fill(document, std::nullopt);
  return setup ? std::move(setup) : wrong(setup.error().message);
}

}  // namespace rmac::gateway
