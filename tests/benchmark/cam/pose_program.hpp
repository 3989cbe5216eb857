#pragma once

#include <functional>
#include <string>
#include <vector>

#include "program.hpp"

namespace rmac::bench {

/// Corners of a program of lines on which the tool axis turns, with tolerances and feed of each.
struct PoseProgram {
  std::vector<ToolPose> corners;
  double tolerance_mm = 0.01;
  double tolerance_deg = 0.1;
  double feed_mm_s = 100;
};

/// A curve of poses on t in [0, 1].
using PoseShape = std::function<ToolPose(double)>;

/// Poses along a curve, spread evenly by its parameter.
[[nodiscard]] std::vector<ToolPose> corners_of(const PoseShape& shape, int lines);
/// Coordinates and axes as a post-processor writes them; points that then repeat are left out.
[[nodiscard]] std::vector<ToolPose> rounded(std::vector<ToolPose> corners, double to_mm, double to_axis);
/// The same curve as one spline in pose space.
[[nodiscard]] Nurbs interpolated(const PoseShape& shape);

struct PoseMachined : Machined {
  double axis_deg = 0;  ///< of the tool axis from what was sent, at the place of the polyline that is nearest
};

/// Machines a program that is queued whole, from rest to rest; the message where it is refused or never ends.
[[nodiscard]] tl::expected<PoseMachined, std::string> machine(const PoseProgram& program, const PlannerModel& model);
[[nodiscard]] tl::expected<Machined, std::string> machine(const Nurbs& pose, const PoseProgram& as,
                                                          const PlannerModel& model);

}  // namespace rmac::bench
