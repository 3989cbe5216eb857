#pragma once

#include <span>
#include <string_view>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::sdk {

/// The RMAC_Config interface (dissertation 4.4, Appendix IV): fills a draft of the mechanism. Nothing acts before
/// `apply`, which checks the draft as a whole and puts it in at standstill, or changes nothing and says why. A setter
/// refuses at once what no draft could make right (a joint number out of range, a negative speed). Gateway thread only.
class RmacConfig {
 public:
  virtual ~RmacConfig() = default;

  /// Starts a new draft from this device object's identity, spindles, actuators and I/O names; joints and modules start
  /// empty.
  virtual Expected<> begin(const DeviceObject& device) = 0;

  virtual Expected<> set_kinematics(const ModuleChoice& module) = 0;
  virtual Expected<> set_actuator_map(const ModuleChoice& module) = 0;
  virtual Expected<> set_number_of_joints(int count) = 0;
  virtual Expected<> set_number_of_spindles(int count) = 0;
  virtual Expected<> set_number_of_actuators(int count) = 0;
  virtual Expected<> set_joint_name(int joint, std::string_view name) = 0;
  virtual Expected<> set_joint_type(int joint, JointType type) = 0;
  virtual Expected<> set_joint_limit_type(int joint, JointLimitType type) = 0;
  virtual Expected<> set_joint_maximum_limit(int joint, double value) = 0;
  virtual Expected<> set_joint_minimum_limit(int joint, double value) = 0;
  virtual Expected<> set_joint_maximum_speed(int joint, double value) = 0;
  virtual Expected<> set_joint_maximum_acceleration(int joint, double value) = 0;
  virtual Expected<> set_joint_maximum_jerk(int joint, double value) = 0;
  virtual Expected<> set_maximum_feedrate(double mm_min) = 0;
  virtual Expected<> set_spindle_maximum_rpm(int spindle, double rpm) = 0;
  virtual Expected<> set_spindle_maximum_torque(int spindle, double torque_nm) = 0;

  virtual Expected<> set_joint_control_method(int joint, ControlMethod method) = 0;
  virtual Expected<> set_joint_servo_control_law(int joint, const ModuleChoice& module) = 0;
  virtual Expected<> set_joint_servo_control_gains(int joint, std::span<const double> gains) = 0;
  /// Following-error and effort bounds of a joint.
  virtual Expected<> set_joint_watch(int joint, double max_following_error, double max_effort) = 0;
  /// Pitch errors, backlash and resonances that the servo loop makes good.
  virtual Expected<> set_joint_mechanics(int joint, const JointMechanics& mechanics) = 0;

  /// Velocity, or Position of a spindle whose drive takes a torque.
  virtual Expected<> set_spindle_control_method(int spindle, ControlMethod method) = 0;
  /// Of a spindle whose drive takes a torque; without a name none, and no gains.
  virtual Expected<> set_spindle_servo_control_law(int spindle, const ModuleChoice& module) = 0;
  virtual Expected<> set_spindle_servo_control_gains(int spindle, std::span<const double> gains) = 0;

  virtual Expected<> set_digital_control_interface(const ModuleChoice& module) = 0;
  virtual Expected<> initialize_digital_control_interface() = 0;
  virtual Expected<> set_digital_io_interface(const ModuleChoice& module) = 0;
  virtual Expected<> initialize_digital_io_interface() = 0;

  /// What the draft holds, applied or not.
  [[nodiscard]] virtual const DeviceObject& draft() const = 0;
  virtual Expected<> apply() = 0;
};

}  // namespace rmac::sdk
