#include "gateway/rmac/commands/programs/material_report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

Result<> check_stock_out(const std::string& file) {
  const std::filesystem::path path(file);
  if (path.extension() != ".stl") return fail(fmt::format("{}: the name of --stock-out ends in .stl", file));
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (std::filesystem::is_directory(path) || ::access(folder.c_str(), W_OK) != 0) {
    return fail(fmt::format("{}: cannot be written; choose another place with --stock-out", file));
  }
  return {};
}

Result<MaterialReport> report_material(const CollisionWatch& watch, const std::string& stock_out) {
  const gateway::Material& material = *watch.material();
  constexpr double kMegabyte = 1e6;
  MaterialReport report;
  report.resolution = *std::ranges::max_element(material.grid().layout().pitch);
  report.tolerance = material.tolerance_mm();
  report.removed_mm3 = material.removed_mm3();
  report.left_mm3 = material.grid().volume_mm3();
  report.memory_mb = static_cast<double>(material.grid().bytes()) / kMegabyte;
  report.strokes = material.strokes();
  report.stock_file = stock_out;
  return report;
}

nlohmann::json to_json(const MaterialReport& report) {
  nlohmann::json object{{"resolution_mm", report.resolution}, {"tolerance_mm", report.tolerance},
                        {"removed_mm3", report.removed_mm3},  {"left_mm3", report.left_mm3},
                        {"memory_mb", report.memory_mb},      {"strokes", report.strokes}};
  if (!report.stock_file.empty()) {
    object["stock_file"] = report.stock_file;
    object["stock_triangles"] = report.stock_triangles;
  }
  return object;
}

void add_rows(const MaterialReport& report, std::vector<std::vector<std::string>>& rows) {
  rows.push_back({"removed", number(report.removed_mm3),
                  report.removed_mm3 > 0 ? fmt::format("mm³; {:.1f} mm³ are left", report.left_mm3)
                                         : "mm³: THE TOOL NEVER CUT THE STOCK"});
  rows.push_back({"material", number(report.resolution),
                  fmt::format("mm from ray to ray, {:.0f} MB; its surface is right to {:.4f} mm", report.memory_mb,
                              report.tolerance)});
  if (!report.stock_file.empty()) {
    rows.push_back({"stock", report.stock_file, fmt::format("{} triangles", report.stock_triangles)});
  }
}

}  // namespace rmac::cli
