#pragma once

#include <Eigen/Core>

namespace rmac::gateway {

/// One way in which a tool's tip swings against the part, as an oscillator of its own.
struct VibrationMode {
  double frequency_hz = 0;  ///< natural, without damping
  double damping_ratio = 0;
  double stiffness_n_mm = 0;     ///< modal, at the tip along its direction
  Eigen::Matrix3d directions{};  ///< d·dᵀ of a unit vector d, or a sum of such: those in which it swings alike
};

}  // namespace rmac::gateway
