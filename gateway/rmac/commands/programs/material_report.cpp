#include "gateway/rmac/commands/programs/material_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <variant>

#include "gateway/material/stock.hpp"
#include "gateway/material/surface.hpp"
#include "gateway/rmac/commands/programs/run_files.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {
namespace {

/// 100 MB: as many as a mesh of a set-up may have is four million.
constexpr std::size_t kMostTriangles = 2'000'000;

}  // namespace

Result<> check_stock_out(const std::string& file, const std::vector<std::filesystem::path>& taken) {
  if (std::filesystem::path(file).extension() != ".stl") {
    return fail(fmt::format("{}: the name of --stock-out ends in .stl", file));
  }
  if (auto fine = refuse_unwritable(file, "--stock-out"); !fine) return fine;
  return refuse_used(file, "--stock-out", taken);
}

Result<MaterialReport> report_material(const CollisionWatch& watch, const std::string& stock_out) {
  const gateway::Material& material = *watch.material();
  constexpr double kMegabyte = 1e6;
  MaterialReport report;
  report.resolution = *std::ranges::max_element(material.grid().layout().pitch);
  report.tolerance = material.tolerance_mm();
  report.removed = material.removed();
  report.left_mm3 = material.left_mm3();
  report.memory_mb = static_cast<double>(material.grid().bytes()) / kMegabyte;
  report.strokes = material.strokes();
  const gateway::Setup& setup = watch.setup();
  if (setup.part && std::holds_alternative<gateway::MeshShape>(setup.part->shape)) {
    const auto part = gateway::Stock::read(*setup.part);
    if (!part) return fail(part.error().message);
    report.deviation = gateway::deviation_of(material.grid(), part->mesh(), setup.tolerance_mm);
    report.part_tolerance = setup.tolerance_mm;
  }
  if (!stock_out.empty()) {
    const auto written = gateway::write_stl(material.grid(), stock_out, kMostTriangles);
    if (!written) return fail(written.error().message);
    report.stock_file = stock_out;
    report.stock_triangles = written->triangles;
    report.stock_apart = written->apart_mm;
  }
  return report;
}

nlohmann::json to_json(const MaterialReport& report) {
  nlohmann::json object{{"resolution_mm", report.resolution}, {"tolerance_mm", report.tolerance},
                        {"removed_mm3", report.removed.mm3},  {"removed_spread_mm3", report.removed.spread_mm3},
                        {"left_mm3", report.left_mm3},        {"memory_mb", report.memory_mb},
                        {"strokes", report.strokes}};
  if (report.removed.mm3 == 0) object["never_cut"] = true;
  if (report.deviation) {
    const gateway::Deviation& d = *report.deviation;
    const auto place = [](const Eigen::Vector3d& p) { return nlohmann::json{p[0], p[1], p[2]}; };
    object["deviation"] = {{"rest_mm", d.rest_mm},
                           {"rest_place_mm", place(d.rest_at)},
                           {"gouge_mm", d.gouge_mm},
                           {"gouge_place_mm", place(d.gouge_at)},
                           {"tolerance_mm", report.part_tolerance},
                           {"share_within_tolerance", d.within_share}};
  }
  if (!report.stock_file.empty()) {
    object["stock_file"] = report.stock_file;
    object["stock_triangles"] = report.stock_triangles;
    object["stock_points_apart_mm"] = report.stock_apart;
  }
  return object;
}

void add_rows(const MaterialReport& report, std::vector<std::vector<std::string>>& rows) {
  rows.push_back({"removed", number(report.removed.mm3),
                  report.removed.mm3 > 0 ? fmt::format("mm³, ± {:.1f} by which way one looks; {:.1f} mm³ are left",
                                                       report.removed.spread_mm3, report.left_mm3)
                                         : "mm³: THE TOOL NEVER CUT THE STOCK"});
  rows.push_back({"material", number(report.resolution),
                  fmt::format("mm from ray to ray, {:.0f} MB; its surface is right to {:.4f} mm", report.memory_mb,
                              report.tolerance)});
  if (report.deviation) {
    const gateway::Deviation& d = *report.deviation;
    const auto at = [](const Eigen::Vector3d& p) { return fmt::format("at {:.2f} {:.2f} {:.2f}", p[0], p[1], p[2]); };
    rows.push_back({"rest", number(d.rest_mm), "mm at most above the part, " + at(d.rest_at)});
    rows.push_back({"gouge", number(d.gouge_mm), "mm at most into the part, " + at(d.gouge_at)});
    rows.push_back({"within", number(100 * d.within_share, 1),
                    fmt::format("% of the part's surface are within {} mm", report.part_tolerance)});
  }
  if (!report.stock_file.empty()) {
    rows.push_back(
        {"stock", report.stock_file,
         fmt::format("{} triangles, of points {:.3g} mm apart", report.stock_triangles, report.stock_apart)});
  }
}

}  // namespace rmac::cli
