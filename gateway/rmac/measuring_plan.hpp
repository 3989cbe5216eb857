#pragma once

#include <map>
#include <string>
#include <vector>

#include "gateway/metrology/alignment.hpp"
#include "gateway/rmac/failure.hpp"

namespace rmac::cli {

/// What `rmac measure` is to measure, in the part frame. mm.
struct MeasuringPlan {
  double safe_height_mm = 0;
  double clearance_mm = 5;
  double tip_radius_mm = 0;
  double speed_mm_s = 20;
  std::vector<gateway::SurfacePoint> points;  ///< normals are unit; not measured yet
  std::map<std::string, int> cut_by;          ///< features by which a tool is judged, not the part's place
};

/// Reads and checks the whole file. An error names file, key, value and range.
[[nodiscard]] Result<MeasuringPlan> read_measuring_plan(const std::string& file);

}  // namespace rmac::cli
