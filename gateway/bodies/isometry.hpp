#pragma once

#include <Eigen/Geometry>

#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

[[nodiscard]] inline Eigen::Isometry3d to_isometry(const Frame& frame) {
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  at.linear() = Eigen::Quaterniond(frame.q[0], frame.q[1], frame.q[2], frame.q[3]).toRotationMatrix();
  at.translation() = Eigen::Vector3d(frame.p[0], frame.p[1], frame.p[2]);
  return at;
}

}  // namespace rmac::gateway
