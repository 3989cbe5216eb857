#include "gateway/rmac/commands/programs/view_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/api/decode.hpp"
#include "gateway/rmac/commands/programs/force_report.hpp"
#include "gateway/rmac/commands/programs/run_files.hpp"
#include "gateway/rmac/view/page.hpp"
#include "gateway/rmac/view/stock_frames.hpp"

namespace rmac::cli {
namespace {

constexpr std::size_t kMostOfStock = 150'000;  ///< triangles: 6 MB of the page

void add_watched(const CollisionWatch& watch, nlohmann::json& data) {
  const auto findings = watch.findings().sorted();
  data["part_frame"] = gateway::frame_to_json(watch.setup().part_frame);
  data["collisions"] = to_json(findings, false);
  data["near_misses"] = to_json(findings, true);
  data["findings_left_off"] = watch.findings().left_off();
  data["not_checked"] = watch.not_checked();
  data["forces_not_told"] = watch.forces_not_told();
  if (watch.load() != nullptr) data["overloads"] = to_json(watch.load()->overloads());
  if (watch.material() != nullptr) data["stock_after"] = drawn_stock(watch.material()->grid(), kMostOfStock);
}

}  // namespace

Result<> check_view(const std::string& file, const ShapedMachine& machine, std::vector<std::filesystem::path> taken) {
  if (std::filesystem::path(file).extension() != ".html") {
    return fail(fmt::format("{}: the name of --view ends in .html", file));
  }
  if (auto fine = refuse_unwritable(file, "--view"); !fine) return fine;
  const auto meshes = files_of(machine.bodies);
  taken.insert(taken.end(), meshes.begin(), meshes.end());
  const auto of_page = files_in(page_folder());
  taken.insert(taken.end(), of_page.begin(), of_page.end());
  return refuse_used(file, "--view", taken);
}

Result<ViewReport> report_view(const Film& film, const CollisionWatch* watch, nlohmann::json dynamics,
                               const std::string& program, const std::string& file) {
  if (film.empty())
    return fail(fmt::format("{}: it moves nothing, so that there is nothing to show with --view", program));
  nlohmann::json data = film.to_json();
  data["program"] = program;
  data["dynamics"] = std::move(dynamics);
  data["checked"] = watch != nullptr;
  if (watch != nullptr) add_watched(*watch, data);
  const auto bytes = write_page(data, file);
  if (!bytes) return tl::unexpected(bytes.error());
  return ViewReport{file, *bytes, film.within_mm()};
}

void add_to_json(const ViewReport& report, nlohmann::json& line) {
  line["view_file"] = report.file;
  line["view_bytes"] = report.bytes;
  line["view_within_mm"] = report.within_mm;
}

std::vector<std::string> row_of(const ViewReport& report) {
  constexpr double kMegabyte = 1e6;
  return {"view", report.file,
          fmt::format("{:.1f} MB; machine within {:g} mm at {:g} looks a second",
                      static_cast<double>(report.bytes) / kMegabyte, report.within_mm, Film::kLooks_per_s)};
}

}  // namespace rmac::cli
