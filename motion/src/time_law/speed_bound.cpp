#include "time_law/speed_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rmac {

double joint_speed_bound(const JointPoint& point, const std::vector<JointLimits>& joints) noexcept {
  double v = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < joints.size(); ++j)
    v = std::min(v, joints[j].max_speed * kLawMargin / std::max(std::abs(point.d[1][j]), 1e-12));
  return v;
}

double feed_bound(const PathSegment& segment, const JointPoint& point, const std::vector<JointLimits>& joints,
                  const FeedRule& feed) noexcept {
  if (!segment.curve().in_joint_space()) return feed.bound(segment);
  const double part = segment.demand().joint_speed_fraction * feed.override_factor;
  return std::min(feed.bound(segment), joint_speed_bound(point, joints) * part);
}

double speed_bound(const PathSegment& segment, const JointPoint& point, const std::vector<JointLimits>& joints,
                   const FeedRule& feed) noexcept {
  return std::min(feed_bound(segment, point, joints, feed), joint_speed_bound(point, joints));
}

}  // namespace rmac
