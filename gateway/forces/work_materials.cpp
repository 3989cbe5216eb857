#include "gateway/forces/work_materials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>

#include "gateway/json/json_document.hpp"
#include "gateway/json/schema_words.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

/// What of a name counts, in any language of the computer.
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) text += c;
    if (c >= 'A' && c <= 'Z') text += static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

WorkMaterial material_of(const Json& entry) {
  return {.name = entry.at("Name"),
          .also_called = entry.value("AlsoCalled", std::vector<std::string>()),
          .coefficients = {.ktc = entry.at("Ktc"),
                           .krc = entry.at("Krc"),
                           .kac = entry.at("Kac"),
                           .kte = entry.at("Kte"),
                           .kre = entry.at("Kre"),
                           .kae = entry.at("Kae")},
          .tool = entry.at("Tool"),
          .source = entry.at("Source")};
}

std::vector<std::string> names_of(const WorkMaterial& material) {
  std::vector<std::string> names{material.name};
  names.insert(names.end(), material.also_called.begin(), material.also_called.end());
  return names;
}

}  // namespace

Expected<WorkMaterials> WorkMaterials::read(const std::filesystem::path& file) {
  static const JsonSchema kSchema(materials_schema_text());
  const auto document = read_json_document(file, kSchema);
  if (!document) return tl::unexpected(document.error());
  WorkMaterials result;
  result.file_ = file;
  std::map<std::string, std::size_t> whose;
  for (const Json& entry : document->at("Materials")) {
    const std::size_t index = result.materials_.size();
    const WorkMaterial& material = result.materials_.emplace_back(material_of(entry));
    for (const std::string& name : names_of(material)) {
      const auto [other, is_new] = whose.emplace(plain(name), index);
      if (is_new || other->second == index) continue;
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("{}: /Materials/{} is called \"{}\", as /Materials/{} is; give each names of its own",
                                 file.string(), index, name, other->second));
    }
  }
  return result;
}

Expected<const WorkMaterial*> WorkMaterials::find(const std::string& name) const {
  const std::string wanted = plain(name);
  std::vector<std::string> known, plain_names, shown;
  for (const WorkMaterial& material : materials_) {
    shown.push_back(fmt::format("\"{}\"", material.name));
    for (const std::string& each : names_of(material)) {
      if (plain(each) == wanted && !wanted.empty()) return &material;
      known.push_back(each);
      plain_names.push_back(plain(each));
    }
  }
  const auto meant = likely_meant(plain_names, wanted);
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("the material \"{}\" is not in {};{} there are {}", name, file_.string(),
                             meant ? fmt::format(" did you mean \"{}\"?", known[*meant]) : "", fmt::join(shown, ", ")));
}

}  // namespace rmac::gateway
