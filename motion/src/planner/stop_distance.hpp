#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// About how far the path goes on until it can come to rest (mm), from a state in motion: braking as hard as every
/// joint's acceleration and jerk allow from step to step, less what the path's bends take of them. An estimate: whether
/// there is a law is for `plan_window` to say.
[[nodiscard]] double stop_distance(const PathView& path, const std::vector<JointLimits>& joints, const PathState& from);

}  // namespace rmac
