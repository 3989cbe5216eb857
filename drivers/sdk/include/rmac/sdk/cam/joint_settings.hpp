#pragma once

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// Speed and accelerations of joint moves, jogs of joints and `home` from now on. Gateway thread only.
class JointSettings {
 public:
  virtual ~JointSettings() = default;

  /// Speed of joint moves and jogs, of each joint's speed limit.
  virtual Expected<> set_interp_speed(double percent) = 0;
  [[nodiscard]] virtual double interp_speed() const = 0;
  /// Acceleration of one joint while its speed rises, mm/s² or degrees/s²; at most the joint's limit.
  virtual Expected<> set_accel_rise(int joint, double value) = 0;
  [[nodiscard]] virtual Expected<double> accel_rise(int joint) const = 0;
  /// Likewise while its speed falls.
  virtual Expected<> set_accel_fall(int joint, double value) = 0;
  [[nodiscard]] virtual Expected<double> accel_fall(int joint) const = 0;
};

}  // namespace rmac::sdk
