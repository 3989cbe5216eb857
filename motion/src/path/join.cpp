#include "path/join.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

bool passable(const JointPoint& below, const JointPoint& above, const std::vector<JointLimits>& joints, double v,
              double period_s) noexcept {
  // What rounding leaves in a client's coordinates, as a part of the jerk limit; anything larger is a corner.
  constexpr double kPart = 1e-3;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double jerk = joints[j].max_jerk * kPart;
    const double speed = v * std::abs(above.d[1][j] - below.d[1][j]);
    const double acceleration = v * v * std::abs(above.d[2][j] - below.d[2][j]);
    if (speed > jerk * period_s * period_s || acceleration > jerk * period_s) return false;
  }
  return true;
}

bool passes_at_speed(const PathSegment& before, const PathSegment& after, const std::vector<JointLimits>& joints,
                     double period_s) noexcept {
  if (before.demand().rest_after || after.demand().rest_before) return false;
  if (before.curve().in_joint_space() != after.curve().in_joint_space()) return false;
  JointPoint below, above;
  if (before.evaluate(before.length(), 2, -1, below) != KinematicsStatus::Ok ||
      after.evaluate(0, 2, 1, above) != KinematicsStatus::Ok)
    return false;
  const double feed = std::max({before.demand().feed_mm_s, after.demand().feed_mm_s, 1.0});
  return passable(below, above, joints, feed, period_s);
}

}  // namespace rmac
