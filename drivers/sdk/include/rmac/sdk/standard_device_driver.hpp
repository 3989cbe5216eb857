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
    MechanismConfig& mechanism = config.mechanism();
    return mechanism.set_number_of_joints(static_cast<int>(device.joints.size()))
        .and_then([&] { return mechanism.set_number_of_spindles(static_cast<int>(device.spindles.size())); })
        .and_then([&] { return mechanism.set_kinematics(device.kinematics); })
        .and_then([&] { return mechanism.set_actuator_map(device.actuator_map); })
        .and_then([&] { return mechanism.set_maximum_feedrate(device.max_feedrate_mm_min); })
        .and_then([&] { return set_spindle_bounds(device.spindles, config.spindles()); })
        .and_then([&] {
          return for_each_joint(device, [&](int number, const Joint& joint) {
            return set_limits(config.joints(), number, joint.limits);
          });
        });
  }

  Expected<> configure_servo_controller(const DeviceObject& device, RmacConfig& config) override {
    return config.mechanism()
        .set_number_of_actuators(static_cast<int>(device.actuators.size()))
        .and_then([&] {
          return for_each_joint(
              device, [&](int number, const Joint& joint) { return set_loop(config.loops(), number, joint); });
        })
        .and_then([&] { return set_spindle_loops(device.spindles, config.spindles()); });
  }

  Expected<> configure_digital_control_interface(const DeviceObject& device, RmacConfig& config) override {
    InterfaceConfig& interfaces = config.interfaces();
    return interfaces.set_control(device.digital_control_interface)
        .and_then([&] { return interfaces.set_io(device.digital_io_interface); })
        .and_then([&] { return interfaces.initialize_control(); })
        .and_then([&] { return interfaces.initialize_io(); });
  }

  Expected<> move(std::int64_t id, const Geometry& geometry, RmacCam& cam) override {
    return cam.queue().add(id, geometry);
  }

 private:
  static Expected<> set_loop(LoopConfig& loops, int number, const Joint& joint) {
    return loops.set_control_method(number, joint.method)
        .and_then([&] { return set_law(loops, number, joint); })
        .and_then([&] { return loops.set_watch(number, joint.max_following_error, joint.max_effort); })
        .and_then([&] { return loops.set_mechanics(number, joint.mechanics); });
  }
  /// None where the joint's drive closes the loop itself.
  static Expected<> set_law(LoopConfig& loops, int number, const Joint& joint) {
    if (joint.servo_law.name.empty()) return {};
    return loops.set_servo_law(number, joint.servo_law).and_then([&] { return loops.set_gains(number, joint.gains); });
  }
  static Expected<> set_spindle_bounds(const std::vector<Spindle>& spindles, SpindleConfig& config) {
    int number = 0;
    for (const Spindle& spindle : spindles) {
      auto done = config.set_maximum_rpm(number, spindle.max_speed_rpm).and_then([&] {
        return config.set_maximum_torque(number, spindle.max_torque_nm);
      });
      if (!done) return done;
      ++number;
    }
    return {};
  }
  static Expected<> set_spindle_loops(const std::vector<Spindle>& spindles, SpindleConfig& config) {
    int number = 0;
    for (const Spindle& spindle : spindles) {
      auto done = config.set_control_method(number, spindle.method)
                      .and_then([&] { return config.set_servo_law(number, spindle.servo_law); })
                      .and_then([&] { return config.set_gains(number, spindle.gains); });
      if (!done) return done;
      ++number;
    }
    return {};
  }

  /// Held joints follow those that are moved.
  template <typename Function>
  static Expected<> for_each_joint(const DeviceObject& device, Function&& set) {
    for (std::size_t number = 0; number < device.joint_count_with_held(); ++number) {
      if (auto done = set(static_cast<int>(number), joint_at(device, number)); !done) return done;
    }
    return {};
  }

  static Expected<> set_limits(JointConfig& joints, int number, const JointLimits& limits) {
    return joints.set_name(number, limits.name)
        .and_then([&] { return joints.set_type(number, limits.type); })
        .and_then([&] { return joints.set_limit_type(number, limits.limit_type); })
        .and_then([&] { return joints.set_minimum_limit(number, limits.min); })
        .and_then([&] { return joints.set_maximum_limit(number, limits.max); })
        .and_then([&] { return joints.set_maximum_speed(number, limits.max_speed); })
        .and_then([&] { return joints.set_maximum_acceleration(number, limits.max_acceleration); })
        .and_then([&] { return joints.set_maximum_jerk(number, limits.max_jerk); });
  }
};

/// Makes one; it takes no parameters.
struct StandardDeviceDriverFactory {
  static DeviceDriver* create(Parameters /*parameters*/, char* /*error*/, std::size_t /*size*/) noexcept {
    return new StandardDeviceDriver();
  }
};

}  // namespace rmac::sdk
