#include "time_law/speed_bound.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

double speed_bound(const PathSegment& segment, const JointPoint& point, const std::vector<JointLimits>& joints,
                   const FeedRule& feed) noexcept {
  const PathDemand& demand = segment.demand();
  double v = feed.bound(segment);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double d = std::abs(point.d[1][j]);
    if (d * v > joints[j].max_speed * kLawMargin) v = joints[j].max_speed * kLawMargin / d;
    if (segment.curve().in_joint_space())
      v = std::min(v, joints[j].max_speed * kLawMargin * demand.joint_speed_fraction * feed.override_factor /
                          std::max(d, 1e-12));
  }
  return v;
}

}  // namespace rmac
