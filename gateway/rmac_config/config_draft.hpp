#pragma once

#include <cstdint>
#include <functional>

#include "rmac/sdk/rmac_config.hpp"

namespace rmac::gateway {

/// RMAC_Config (dissertation 4.4): the draft of a mechanism. Checks each value as far as it can be checked alone;
/// whether they fit together is found out by `apply`. Gateway thread only.
class ConfigDraft final : public sdk::RmacConfig {
 public:
  /// How far a draft goes beyond what is in force.
  enum class Extent : std::uint8_t {
    Loops,          ///< servo laws of joints and what belongs to them; none comes or goes, and no joint leaves the plan
    Configuration,  ///< the same mechanism, with anything changed
    Mechanism,      ///< another one
  };
  struct Controller {
    /// Puts a device object in force.
    std::function<Expected<>(const sdk::DeviceObject& device, Extent extent)> apply;
    std::function<Expected<>(const sdk::ModuleChoice& choice)> check_control_interface;
    std::function<Expected<>(const sdk::ModuleChoice& choice)> check_io_interface;
  };

  explicit ConfigDraft(Controller controller) : controller_(std::move(controller)) {}

  /// Forgets the draft and continues from `in_force`, or from nothing.
  void discard(const sdk::DeviceObject* in_force);

  Expected<> begin(const sdk::DeviceObject& device) override;
  Expected<> set_kinematics(const sdk::ModuleChoice& module) override;
  Expected<> set_actuator_map(const sdk::ModuleChoice& module) override;
  Expected<> set_number_of_joints(int count) override;
  Expected<> set_number_of_spindles(int count) override;
  Expected<> set_number_of_actuators(int count) override;
  Expected<> set_joint_name(int joint, std::string_view name) override;
  Expected<> set_joint_type(int joint, JointType type) override;
  Expected<> set_joint_limit_type(int joint, JointLimitType type) override;
  Expected<> set_joint_maximum_limit(int joint, double value) override;
  Expected<> set_joint_minimum_limit(int joint, double value) override;
  Expected<> set_joint_maximum_speed(int joint, double value) override;
  Expected<> set_joint_maximum_acceleration(int joint, double value) override;
  Expected<> set_joint_maximum_jerk(int joint, double value) override;
  Expected<> set_maximum_feedrate(double mm_min) override;
  Expected<> set_spindle_maximum_rpm(int spindle, double rpm) override;
  Expected<> set_spindle_maximum_torque(int spindle, double torque_nm) override;
  Expected<> set_joint_control_method(int joint, ControlMethod method) override;
  Expected<> set_joint_servo_control_law(int joint, const sdk::ModuleChoice& module) override;
  Expected<> set_joint_servo_control_gains(int joint, std::span<const double> gains) override;
  Expected<> set_joint_watch(int joint, double max_following_error, double max_effort) override;
  Expected<> set_joint_mechanics(int joint, const JointMechanics& mechanics) override;
  Expected<> set_spindle_control_method(int spindle, ControlMethod method) override;
  Expected<> set_spindle_servo_control_law(int spindle, const sdk::ModuleChoice& module) override;
  Expected<> set_spindle_servo_control_gains(int spindle, std::span<const double> gains) override;
  Expected<> set_digital_control_interface(const sdk::ModuleChoice& module) override;
  Expected<> initialize_digital_control_interface() override;
  Expected<> set_digital_io_interface(const sdk::ModuleChoice& module) override;
  Expected<> initialize_digital_io_interface() override;
  [[nodiscard]] const sdk::DeviceObject& draft() const override { return draft_; }
  Expected<> apply() override;

 private:
  /// Joints count first, held joints follow.
  [[nodiscard]] Expected<sdk::Joint*> joint(int number, const char* function);
  /// The draft, for whatever is more than a law.
  [[nodiscard]] sdk::DeviceObject& edit() noexcept;
  template <typename Change>
  Expected<> change_joint(int number, const char* function, Change&& change);
  [[nodiscard]] Expected<sdk::Spindle*> spindle(int number, const char* function);
  Expected<> set_limit(int number, const char* function, const char* key, double value, double JointLimits::*member);

  Controller controller_;
  sdk::DeviceObject draft_;
  std::vector<sdk::Joint> described_;  ///< what device.json says of each joint that no setter does
  std::vector<sdk::Spindle> described_spindles_;
  bool begun_ = false;
  Extent extent_ = Extent::Loops;
};

}  // namespace rmac::gateway
