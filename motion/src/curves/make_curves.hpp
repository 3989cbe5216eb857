#pragma once

#include <memory>
#include <span>
#include <vector>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"

namespace rmac {

/// Where a move begins: the pose and joints at the end of what is queued.
struct CurveStart {
  ToolPose pose;
  std::span<const double> joints;
  double tolerance_mm = 0;  ///< by which data that do not quite fit each other may be missed
};

/// The curves of one move, in order: none for a positioning move to where the machine stands already. Where a curve has
/// a corner inside (a knot of full multiplicity), or a jump of its tangent, it is cut there; so are straight stretches
/// with control points that coincide, which become lines. Refuses degenerate
/// geometry (zero length, coincident arc points, bad knots, bad weights, NaN), and a start further than 1 µm (1e-6 of
/// axis) from `start`, with a message that names the value and the rule. A start closer than that is taken up: the
/// first curve begins exactly at `start`, and lies within the gap of what was asked for (docs/derivations/curves.md,
/// section 6).
[[nodiscard]] Expected<std::vector<std::unique_ptr<const Curve>>> make_curves(const Move& move,
                                                                              const CurveStart& start);

}  // namespace rmac
