#pragma once

#include <optional>

#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Where a segment through the joints' space leads them to where they have no pose, in steps of a tenth of a mm or
/// degree: joints that have one keep it, and those that stood without one have one in the end.
[[nodiscard]] std::optional<double> find_pose_loss(const PathSegment& segment);

}  // namespace rmac
