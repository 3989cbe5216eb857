#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Whether two adjoining points of a path (its derivatives from below and from above) can be passed at speed `v`
/// without a step of joint velocity or acceleration that a controller of this period would see as jerk.
[[nodiscard]] bool passable(const JointPoint& below, const JointPoint& above, const std::vector<JointLimits>& joints,
                            double v, double period_s) noexcept;

/// Whether the path may go on from one segment to the next at their feed: no demanded rest, no change of space, no
/// corner.
[[nodiscard]] bool passes_at_speed(const PathSegment& before, const PathSegment& after,
                                   const std::vector<JointLimits>& joints, double period_s) noexcept;

}  // namespace rmac
