#pragma once

#include <span>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/config/module_choice.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::sdk {

/// What a draft says of the mechanism as a whole. Gateway thread only.
class MechanismConfig {
 public:
  virtual ~MechanismConfig() = default;

  virtual Expected<> set_kinematics(const ModuleChoice& module) = 0;
  virtual Expected<> set_actuator_map(const ModuleChoice& module) = 0;
  /// Joints that the mechanism moves; held joints count behind them.
  virtual Expected<> set_number_of_joints(int count) = 0;
  virtual Expected<> set_number_of_spindles(int count) = 0;
  virtual Expected<> set_number_of_actuators(int count) = 0;
  virtual Expected<> set_maximum_feedrate(double mm_min) = 0;
  /// Which drives are behind joints and held joints, in the order of the actuator map; their number too.
  virtual Expected<> set_actuators(std::span<const Actuator> actuators) = 0;
  /// The spindles, all that is known of them; their number too.
  virtual Expected<> set_spindles(std::span<const Spindle> spindles) = 0;
};

}  // namespace rmac::sdk
