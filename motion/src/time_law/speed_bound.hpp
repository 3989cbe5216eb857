#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// How fast the path may be travelled: the programmed feed times the override, and never above the machine's largest
/// feed.
struct FeedRule {
  double override_factor = 1;
  double largest_mm_s = std::numeric_limits<double>::infinity();

  [[nodiscard]] double bound(const PathSegment& segment) const noexcept {
    const double feed = segment.demand().feed_mm_s * override_factor;
    return segment.curve().in_joint_space() ? feed : std::min(feed, largest_mm_s);
  }
};

/// A path acceleration that a move demands, where 0 stands for none.
[[nodiscard]] inline double or_unbounded(double acceleration) noexcept {
  return acceleration > 0 ? acceleration : std::numeric_limits<double>::infinity();
}

/// Planning stays this part inside the limits, so that what a check finds between grid points still keeps the limits
/// themselves.
inline constexpr double kLawMargin = 0.9985;

/// The speed that the joints' speeds alone allow at a point of the path, in mm/s.
[[nodiscard]] double joint_speed_bound(const JointPoint& point, const std::vector<JointLimits>& joints) noexcept;

/// The speed that the feed alone allows at a point of the path, in mm/s.
[[nodiscard]] double feed_bound(const PathSegment& segment, const JointPoint& point,
                                const std::vector<JointLimits>& joints, const FeedRule& feed) noexcept;

/// Both, in mm/s.
[[nodiscard]] double speed_bound(const PathSegment& segment, const JointPoint& point,
                                 const std::vector<JointLimits>& joints, const FeedRule& feed) noexcept;

}  // namespace rmac
