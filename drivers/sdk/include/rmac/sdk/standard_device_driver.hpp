#pragma once

#include <cstddef>

#include "rmac/sdk/device_driver.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::sdk {

/// What most mechanisms need: passes the device object on to RMAC_Config, joint by joint, as section 4.6 tells. Joints
/// come first, then the held joints, which the servo controller drives and the motion planner never moves.
class StandardDeviceDriver : public DeviceDriver {
 public:
  Expected<> configure_motion_planner(const DeviceObject& device, RmacConfig& config) override {
    return config.set_number_of_joints(static_cast<int>(device.joints.size()))
        .and_then([&] { return config.set_number_of_spindles(static_cast<int>(device.spindles.size())); })
        .and_then([&] { return config.set_kinematics(device.kinematics); })
        .and_then([&] { return config.set_actuator_map(device.actuator_map); })
        .and_then([&] { return config.set_maximum_feedrate(device.max_feedrate_mm_min); })
        .and_then([&] { return set_spindle_bounds(device.spindles, config); })
        .and_then([&] {
          return for_each_joint(device.joints, 0, [&](int number, const Joint& joint) {
            return set_limits(config, number, joint.limits);
          });
        })
        .and_then([&] {
          return for_each_joint(
              device.held_joints, static_cast<int>(device.joints.size()),
              [&](int number, const Joint& joint) { return set_limits(config, number, joint.limits); });
        });
  }

  Expected<> configure_servo_controller(const DeviceObject& device, RmacConfig& config) override {
    const auto set_loop = [&](int number, const Joint& joint) {
      return config.set_joint_control_method(number, joint.method)
          .and_then([&] { return set_law(config, number, joint); })
          .and_then([&] { return config.set_joint_watch(number, joint.max_following_error, joint.max_effort); })
          .and_then([&] { return config.set_joint_mechanics(number, joint.mechanics); });
    };
    return config.set_number_of_actuators(static_cast<int>(device.actuators.size()))
        .and_then([&] { return for_each_joint(device.joints, 0, set_loop); })
        .and_then([&] { return for_each_joint(device.held_joints, static_cast<int>(device.joints.size()), set_loop); })
        .and_then([&] { return set_spindle_loops(device.spindles, config); });
  }

  Expected<> configure_digital_control_interface(const DeviceObject& device, RmacConfig& config) override {
    return config.set_digital_control_interface(device.digital_control_interface)
        .and_then([&] { return config.set_digital_io_interface(device.digital_io_interface); })
        .and_then([&] { return config.initialize_digital_control_interface(); })
        .and_then([&] { return config.initialize_digital_io_interface(); });
  }

  Expected<> move(std::int64_t id, const Geometry& geometry, RmacCam& cam) override {
    return cam.queue_move(id, geometry);
  }

 private:
  /// None where the joint's drive closes the loop itself.
  static Expected<> set_law(RmacConfig& config, int number, const Joint& joint) {
    if (joint.servo_law.name.empty()) return {};
    return config.set_joint_servo_control_law(number, joint.servo_law).and_then([&] {
      return config.set_joint_servo_control_gains(number, joint.gains);
    });
  }
  static Expected<> set_spindle_bounds(const std::vector<Spindle>& spindles, RmacConfig& config) {
    int number = 0;
    for (const Spindle& spindle : spindles) {
      auto done = config.set_spindle_maximum_rpm(number, spindle.max_speed_rpm).and_then([&] {
        return config.set_spindle_maximum_torque(number, spindle.max_torque_nm);
      });
      if (!done) return done;
      ++number;
    }
    return {};
  }
  static Expected<> set_spindle_loops(const std::vector<Spindle>& spindles, RmacConfig& config) {
    int number = 0;
    for (const Spindle& spindle : spindles) {
      auto done = config.set_spindle_control_method(number, spindle.method)
                      .and_then([&] { return config.set_spindle_servo_control_law(number, spindle.servo_law); })
                      .and_then([&] { return config.set_spindle_servo_control_gains(number, spindle.gains); });
      if (!done) return done;
      ++number;
    }
    return {};
  }

  template <typename Function>
  static Expected<> for_each_joint(const std::vector<Joint>& joints, int first, Function&& set) {
    for (const Joint& joint : joints) {
      if (auto done = set(first++, joint); !done) return done;
    }
    return {};
  }

  static Expected<> set_limits(RmacConfig& config, int number, const JointLimits& limits) {
    return config.set_joint_name(number, limits.name)
        .and_then([&] { return config.set_joint_type(number, limits.type); })
        .and_then([&] { return config.set_joint_limit_type(number, limits.limit_type); })
        .and_then([&] { return config.set_joint_minimum_limit(number, limits.min); })
        .and_then([&] { return config.set_joint_maximum_limit(number, limits.max); })
        .and_then([&] { return config.set_joint_maximum_speed(number, limits.max_speed); })
        .and_then([&] { return config.set_joint_maximum_acceleration(number, limits.max_acceleration); })
        .and_then([&] { return config.set_joint_maximum_jerk(number, limits.max_jerk); });
  }
};

/// Makes one; it takes no parameters.
struct StandardDeviceDriverFactory {
  static DeviceDriver* create(Parameters /*parameters*/, char* /*error*/, std::size_t /*size*/) noexcept {
    return new StandardDeviceDriver();
  }
};

}  // namespace rmac::sdk
