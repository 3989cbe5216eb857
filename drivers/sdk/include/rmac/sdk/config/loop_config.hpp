#pragma once

#include <span>

#include "rmac/motion/error.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/motion/joint_mechanics.hpp"
#include "rmac/sdk/config/module_choice.hpp"

namespace rmac::sdk {

/// What a draft says of one joint's servo loop. Held joints count behind those that are moved. Gateway thread only.
class LoopConfig {
 public:
  virtual ~LoopConfig() = default;

  virtual Expected<> set_control_method(int joint, ControlMethod method) = 0;
  virtual Expected<> set_servo_law(int joint, const ModuleChoice& module) = 0;
  /// In the law's own order.
  virtual Expected<> set_gains(int joint, std::span<const double> gains) = 0;
  /// Following-error and effort bounds of a joint.
  virtual Expected<> set_watch(int joint, double max_following_error, double max_effort) = 0;
  /// Pitch errors, backlash and resonances that the servo loop makes good.
  virtual Expected<> set_mechanics(int joint, const JointMechanics& mechanics) = 0;
};

}  // namespace rmac::sdk
