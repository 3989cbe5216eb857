#pragma once

#include <span>
#include <vector>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/pose_to_joints.hpp"

namespace rmac {

/// Places of a curve at which its joints are known.
struct JointNodes {
  std::vector<double> places;  ///< path lengths, ascending; empty: the curve's own nodes are enough
  std::vector<double> joints;  ///< a value for each joint, place by place
  KinematicsStatus status = KinematicsStatus::Ok;
  double s_failed = 0;  ///< where `status` is another
};

/// The joints at the curve's own nodes, and at as many places between them as it takes for the cubic through two
/// neighbours and their derivatives to tell the joints between them. The curve knows nothing of the machine: where an
/// arm leads its tool along a straight line, or slides make good for a turn, joints bend although the curve does not,
/// and may come to the end of their reach between places that they reach. Singular where joints would have to jump.
[[nodiscard]] JointNodes joint_nodes(const Curve& curve, const PoseToJoints& map, std::span<const double> start_joints);

}  // namespace rmac
