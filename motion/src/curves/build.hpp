#pragma once

#include <memory>
#include <vector>

#include "make_curves.hpp"

namespace rmac::curves {

using CurvePtr = std::unique_ptr<const Curve>;
using CurveList = std::vector<CurvePtr>;

/// A start may be this far from the end of what is queued; what is less is taken up by the curve, so that setpoints do
/// not jump.
inline constexpr double kStartTolerance_mm = 1e-3;
inline constexpr double kStartTolerance_axis = 1e-6;
/// What is shorter than this does not move.
inline constexpr double kZeroLength_mm = 1e-6;
/// A planner's grid is never finer than this, in mm (or joint units, or degrees). A near-cusp of 0.1 µm radius is still
/// resolved; halving closes in on it, so that fine nodes cost a few, not many.
inline constexpr double kNodeSpacing = 1e-5;
/// Nodes at most this far apart in turn of the tangent or the tool axis.
inline constexpr double kNodeTurn_rad = 0.1;

[[nodiscard]] inline tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

/// Each takes a geometry whose start has been checked, and begins exactly at `start`. Null where it ends there too, as
/// points that repeat in a program do.
[[nodiscard]] Expected<CurvePtr> make_line(const ToolPose& start, const ToolPose& end);
[[nodiscard]] Expected<CurvePtr> make_joint_line(std::span<const double> start, std::span<const double> end);
[[nodiscard]] Expected<CurvePtr> make_arc(const ArcGeometry& arc, const ToolPose& start, double tolerance_mm);
[[nodiscard]] Expected<CurvePtr> make_arc3(const Arc3Geometry& arc, const ToolPose& start);
/// Checks the curve's start too, because a NURBS' start is known only once its data are found sound.
[[nodiscard]] Expected<CurveList> make_nurbs(const NurbsGeometry& geometry, const CurveStart& start);

/// Refuses a start that is further from the end of the queue than the tolerances above.
[[nodiscard]] Expected<> check_start(const Vector& tip, const CurveStart& start);
[[nodiscard]] Expected<> check_start_axis(const Vector& axis, const CurveStart& start);

/// Evenly spaced arc lengths from 0 to `length`, so that `turn_rad` between neighbours stays under `kNodeTurn_rad`.
[[nodiscard]] std::vector<double> even_nodes(double length, double turn_rad);

/// Nodes for a curve of which curvature is known by evaluation only: every interval of `knots` (ascending, from 0 to
/// the length) is halved until turn and change of curvature are small, see docs/derivations/curves.md, section 5.
/// `probes`: further places (ascending) to look at, so that no sharp bend hides between the ends and the middle of an
/// interval.
[[nodiscard]] std::vector<double> curvature_nodes(const Curve& curve, std::span<const double> knots,
                                                  std::span<const double> probes);

}  // namespace rmac::curves
