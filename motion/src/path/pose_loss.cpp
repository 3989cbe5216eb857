#include "path/pose_loss.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

std::optional<double> find_pose_loss(const PathSegment& segment) {
  constexpr double kStep = 0.1, kMostSteps = 20'000;
  const double length = segment.length(), steps = std::clamp(std::ceil(length / kStep), 1.0, kMostSteps);
  const Kinematics& kinematics = segment.map()->kinematics();
  JointPoint point;
  bool has = false;
  for (double i = 0; i <= steps; ++i) {
    const double s = length * i / steps;
    if (segment.evaluate(s, 0, i == 0 ? 1 : -1, point) != KinematicsStatus::Ok) return s;
    const bool here = kinematics.has_pose({point.d[0].data(), segment.joint_count()});
    if (!here && (has || i == steps)) return s;
    has = here;
  }
  return std::nullopt;
}

}  // namespace rmac
