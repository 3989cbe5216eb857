#pragma once

#include <Eigen/Dense>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// Of efforts of joints and actuators. The sizes are bounded at compile time, so that Eigen keeps these on the stack.
using EffortMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, int{kMaxJoints}, int{kMaxJoints}>;
using EffortVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, int{kMaxJoints}, 1>;

}  // namespace rmac
