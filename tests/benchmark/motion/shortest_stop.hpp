#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/time_law.hpp"

namespace rmac::bench {

/// Distance in which a state on a segment comes to rest when braking as hard as the joints allow at each place: the
/// lowest path acceleration and jerk first, then the highest jerk, switched at the instant (found by bisection) that
/// brings speed and acceleration to zero together. NaN where the segment ends before.
[[nodiscard]] double shortest_stop_mm(const PathSegment& segment, const std::vector<JointLimits>& joints,
                                      const PathState& from);

}  // namespace rmac::bench
