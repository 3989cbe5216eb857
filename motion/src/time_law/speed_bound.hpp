#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"
#include "time_law/feed_rule.hpp"

namespace rmac {

/// Planning stays this part inside the limits, so that what a check finds between grid points still keeps the limits
/// themselves.
inline constexpr double kLawMargin = 0.9985;

/// The speed that the feed and the joints' speeds allow at a point of the path, in mm/s.
[[nodiscard]] double speed_bound(const PathSegment& segment, const JointPoint& point,
                                 const std::vector<JointLimits>& joints, const FeedRule& feed) noexcept;

}  // namespace rmac
