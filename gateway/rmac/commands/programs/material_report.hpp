#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/material/deviation.hpp"
#include "gateway/rmac/simulator/collision_watch.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What `rmac simulate` says of the material when the run is over. mm.
struct MaterialReport {
  double resolution = 0, tolerance = 0;  ///< rays apart; what the surface may be off by the tool's motion
  gateway::RemovedVolume removed;
  double left_mm3 = 0;
  double memory_mb = 0;
  std::size_t strokes = 0;
  std::optional<gateway::Deviation> deviation;  ///< from the part; none: the set-up has no mesh of it
  double part_tolerance = 0;
  std::string stock_file;  ///< empty: none was asked for
  std::size_t stock_triangles = 0;
  double stock_apart = 0;  ///< the points of its surface, at most
};

/// Refuses a file that could not be written, before anything is done for it, what is no regular file, and files that
/// are `taken` otherwise.
[[nodiscard]] Result<> check_stock_out(const std::string& file, const std::vector<std::filesystem::path>& taken);
/// Of a run that is over, with a set-up that has a stock; writes the file, if any.
[[nodiscard]] Result<MaterialReport> report_material(const CollisionWatch& watch, const std::string& stock_out);

[[nodiscard]] nlohmann::json to_json(const MaterialReport& report);
/// Rows of the table: what, how much, and a remark.
void add_rows(const MaterialReport& report, std::vector<std::vector<std::string>>& rows);

}  // namespace rmac::cli
