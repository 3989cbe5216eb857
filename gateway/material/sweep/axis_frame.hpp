#pragma once

#include <Eigen/Geometry>

namespace rmac::gateway {

/// Turns vectors of the part frame into those of a frame whose z is `axis`, unit; x and y lie as they fall.
[[nodiscard]] inline Eigen::Matrix3d across_axis(const Eigen::Vector3d& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d x = axis.cross(Eigen::Vector3d::Unit(least)).normalized();
  Eigen::Matrix3d turned;
  turned.row(0) = x;
  turned.row(1) = axis.cross(x);
  turned.row(2) = axis;
  return turned;
}

/// How far a disc across `axis` reaches along each axis of the part frame, from its middle.
[[nodiscard]] inline Eigen::Vector3d reach_of_disc(const Eigen::Vector3d& axis, double radius) {
  return radius * (Eigen::Vector3d::Ones() - axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
}

}  // namespace rmac::gateway
