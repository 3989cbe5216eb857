#include "joins/pose_derivatives.hpp"

#include <algorithm>

#include "path/least_squares.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

constexpr std::size_t kPoseDimension = 6;
/// Step of the joint that moves most, for differences of the Jacobian: as of docs/derivations/joint-path.md.
constexpr double kJointStep = 0.01;

}  // namespace

KinematicsStatus pose_derivatives(const PathSegment& segment, double s, int side, CurvePoint& point) {
  segment.curve().evaluate(s, 2, side, point);
  if (segment.curve().dimension() <= kPoseDimension) return KinematicsStatus::Ok;
  JointPoint joints;
  const auto status = segment.evaluate(s, 2, side, joints);
  if (status != KinematicsStatus::Ok) return status;
  const PoseToJoints& map = *segment.map();
  const std::size_t n = map.joint_count();
  const auto jacobian_at = [&](double by, PoseRows& rows) {
    JointColumn q;
    for (std::size_t j = 0; j < n; ++j) q[j] = joints.d[0][j] + by * joints.d[1][j];
    map.kinematics().jacobian({q.data(), n}, map.frames().tool, {rows.data(), 6 * n});
  };
  double fastest = 1;
  for (std::size_t j = 0; j < n; ++j) fastest = std::max(fastest, std::abs(joints.d[1][j]));
  const double h = kJointStep / fastest;
  PoseRows here, ahead, behind;
  jacobian_at(0, here);
  jacobian_at(h, ahead);
  jacobian_at(-h, behind);
  // a' = J x', a'' = J x'' + dJ[x'] x', of the axis' rows.
  Vector first{}, second{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t i = (3 + c) * n + j;
      first[c] += here[i] * joints.d[1][j];
      second[c] += here[i] * joints.d[2][j] + (ahead[i] - behind[i]) / (2 * h) * joints.d[1][j];
    }
  }
  const Frame to_part = inverse(map.frames().part);
  first = apply_to_vector(to_part, first);
  second = apply_to_vector(to_part, second);
  std::copy(first.begin(), first.end(), point.d[1].begin() + 3);
  std::copy(second.begin(), second.end(), point.d[2].begin() + 3);
  return KinematicsStatus::Ok;
}

}  // namespace rmac
