#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/metrology/alignment.hpp"
#include "gateway/metrology/tool_offset.hpp"
#include "gateway/rmac/measuring/measuring_plan.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

/// What a tool that cut measured features is off.
struct ToolFound {
  int number = 0;
  gateway::ToolOffset offset;
};

/// What came out of a measuring plan, as it is told.
struct MeasureReport {
  std::vector<ToolFound> tools;
  std::vector<gateway::FeatureDeviation> before, after;
  std::optional<Frame> off;         ///< of the part from where it was taken to be
  std::optional<Frame> part_frame;  ///< in which the deviations are those of `after`
  std::string why_not;              ///< there is none
  bool applied = false;
};

/// Prints what came out of a plan whose points are measured: one line of JSON, or tables for a person.
void print_json(const MeasuringPlan& plan, const MeasureReport& report);
void print_table(const MeasureReport& report);

}  // namespace rmac::cli
