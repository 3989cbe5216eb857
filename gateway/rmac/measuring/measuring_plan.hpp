#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/metrology/alignment.hpp"
#include "gateway/rmac/measuring/prober.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// What `rmac measure` is to measure, in the part frame. mm.
struct MeasuringPlan {
  ProbeWays ways;
  std::optional<double> tip_radius_mm;        ///< none: that of the tool in the spindle
  std::vector<gateway::SurfacePoint> points;  ///< normals are unit; not measured yet
  std::map<std::string, int> cut_by;          ///< features by which a tool is judged, not the part's place
};

/// Reads and checks the whole file. An error names file, key, value and range.
[[nodiscard]] Result<MeasuringPlan> read_measuring_plan(const std::string& file);

}  // namespace rmac::cli
