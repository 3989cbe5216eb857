#pragma once

#include <span>

#include "rmac/motion/error.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/sdk/config/module_choice.hpp"

namespace rmac::sdk {

/// What a draft says of one spindle. Gateway thread only.
class SpindleConfig {
 public:
  virtual ~SpindleConfig() = default;

  virtual Expected<> set_maximum_rpm(int spindle, double rpm) = 0;
  virtual Expected<> set_maximum_torque(int spindle, double torque_nm) = 0;
  /// Velocity; or Position, where the drive takes a torque.
  virtual Expected<> set_control_method(int spindle, ControlMethod method) = 0;
  /// For a drive that takes a torque; without a name none, and no gains.
  virtual Expected<> set_servo_law(int spindle, const ModuleChoice& module) = 0;
  virtual Expected<> set_gains(int spindle, std::span<const double> gains) = 0;
};

}  // namespace rmac::sdk
