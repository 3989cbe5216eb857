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

double speed_bound(const PathSegment& segment, const JointPoint& point, const std::vector<JointLimits>& joints,
                   const FeedRule& feed) noexcept {
  const double fastest = joint_speed_bound(point, joints);
  const double v = std::min(feed.bound(segment), fastest);
  if (!segment.curve().in_joint_space()) return v;
  return std::min(v, fastest * segment.demand().joint_speed_fraction * feed.override_factor);
}

}  // namespace rmac
