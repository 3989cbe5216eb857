#include "gateway/collision/setup/setup.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/bodies/body_json.hpp"
#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

Expected<> read_bodies(const Json& document, const std::filesystem::path& folder, Setup& setup) {
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

}  // namespace

Expected<Setup> read_setup(const std::filesystem::path& file) {
  static const JsonSchema kSchema(setup_schema_text());
  const auto document = read_json_document(file, kSchema);
  if (!document) return tl::unexpected(document.error());
  Setup setup;
  setup.machine = (*document)["Machine"];
  setup.material = document->value("Material", "");
  setup.clearance_mm = document->value("Clearance", setup.clearance_mm);
  setup.tolerance_mm = document->value("Tolerance", setup.tolerance_mm);
  if (document->contains("Resolution")) setup.resolution_mm = (*document)["Resolution"].get<double>();
  const auto fill = [&]() -> Expected<> {
    if (document->contains("PartFrame")) {
      auto frame = read_frame((*document)["PartFrame"], "/PartFrame");
      if (!frame) return tl::unexpected(frame.error());
      setup.part_frame = *frame;
    }
    return read_bodies(*document, file.parent_path(), setup);
  };
  if (auto filled = fill(); !filled) {
    return failure(filled.error().code, fmt::format("{}: {}", file.string(), filled.error().message));
  }
  return setup;
}

}  // namespace rmac::gateway
