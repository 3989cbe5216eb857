// Device.Machine_Set…: changes to the device object that Device.Machine_Configure… then puts in (Appendix III).
#include "gateway/api/joint_of.hpp"
#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using sdk::DeviceObject;

/// A setter of one value of one joint.
template <typename T, typename Function>
Method joint_setter(const char* name, const char* meaning, Parameter<T> value, Function function) {
  return method(name, meaning)
      .takes(joint_number(), std::move(value))
      .needs(Permission::Authority)
      .does([function](Call& call, std::int64_t joint, T wanted) {
        return call.machine.device()
            .wanted()
            .and_then([&](DeviceObject* device) { return joint_of(*device, joint); })
            .map([&](sdk::Joint* found) { function(*found, wanted); });
      });
}

Expected<sdk::Spindle*> spindle_of(DeviceObject* device) {
  if (device->spindles.empty()) return failure(MinorCode::InvalidParameter, device->name + " has no spindle");
  return &device->spindles.front();
}

Expected<> set_torque(sdk::Spindle& spindle, double torque_nm) {
  if (spindle.scale.rated_torque_nm == 0) {
    return failure(MinorCode::InvalidParameterValue,
                   "Machine_SetMechanismSpindleMaxTorque: the drive of spindle 0 (bus " + spindle.bus + ", axis " +
                       std::to_string(spindle.axis) +
                       ") tells no torque, so nothing holds it to one; give its RatedTorque in device.json, if it "
                       "measures one");
  }
  spindle.max_torque_nm = torque_nm;
  return {};
}

}  // namespace

void add_device_setters(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  using J = sdk::Joint;
  add(method("Device.Machine_SetMechanismNumberOfJoints",
             "Wanted number of joints. Acts with the next Machine_ConfigureMotionPlanner, which refuses what "
             "modules do not fit.")
          .takes(integer("NumJnts").within(1, static_cast<double>(kMaxJoints)))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t count) {
            return call.machine.device().wanted().map(
                [&](DeviceObject* device) { device->joints.resize(static_cast<std::size_t>(count)); });
          }));
  add(method("Device.Machine_SetMechanismMaxFeedrate",
             "Wanted largest feed. Acts with the next Machine_ConfigureMotionPlanner.")
          .takes(number("MaxFeedrate", "mm/min").within(device_range("MaxFeedrate")))
          .needs(Permission::Authority)
          .does([](Call& call, double feed) {
            return call.machine.device().wanted().map(
                [&](DeviceObject* device) { device->max_feedrate_mm_min = feed; });
          }));
  add(method("Device.Machine_SetMechanismSpindleMaxSpeed",
             "Wanted largest speed of spindle 0. Acts with the next Machine_ConfigureMotionPlanner.")
          .takes(number("MaxSpindleSpeed", "rpm").within(device_range("spindle/MaxSpeed")).at_least(1))
          .needs(Permission::Authority)
          .does([](Call& call, double rpm) {
            return call.machine.device().wanted().and_then(spindle_of).map([rpm](sdk::Spindle* spindle) {
              spindle->max_speed_rpm = rpm;
            });
          }));
  add(method(
          "Device.Machine_SetMechanismSpindleMaxTorque",
          "Wanted largest torque of spindle 0: its servo law gives no more, and measured it is an overload that stops "
          "the machine. Acts with the next Machine_ConfigureMotionPlanner.")
          .takes(number("MaxSpindleTorque", "N·m").within(device_range("spindle/MaxTorque")).above(0))
          .needs(Permission::Authority)
          .does([](Call& call, double torque_nm) {
            return call.machine.device().wanted().and_then(spindle_of).and_then([&](sdk::Spindle* spindle) {
              return set_torque(*spindle, torque_nm);
            });
          }));
  add(joint_setter("Device.Machine_SetMechanismJntTypes",
                   "Wanted type of a joint. Acts with the next Machine_ConfigureMotionPlanner.",
                   choice("JntType", kJointTypeValues),
                   [](J& joint, std::int64_t type) { joint.limits.type = static_cast<JointType>(type); }));
  add(joint_setter("Device.Machine_SetMechanismJntMaxLimit",
                   "Wanted upper end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner.",
                   number("MaxJntLimit", "mm or deg").within(device_range("joint/Max")),
                   [](J& joint, double value) { joint.limits.max = value; }));
  add(joint_setter("Device.Machine_SetMechanismJntMinLimit",
                   "Wanted lower end of a joint's travel. Acts with the next Machine_ConfigureMotionPlanner.",
                   number("MinJntLimit", "mm or deg").within(device_range("joint/Min")),
                   [](J& joint, double value) { joint.limits.min = value; }));
  add(joint_setter("Device.Machine_SetMechanismJntMaxSpeed",
                   "Wanted largest speed of a joint. Acts with the next Machine_ConfigureMotionPlanner.",
                   number("MaxJntSpeed", "mm/s or deg/s").within(device_range("joint/MaxSpeed")),
                   [](J& joint, double value) { joint.limits.max_speed = value; }));
  add(joint_setter("Device.Machine_SetMechanismJntMaxAccel",
                   "Wanted largest acceleration of a joint. Acts with the next Machine_ConfigureMotionPlanner.",
                   number("MaxJntAccel", "mm/s² or deg/s²").within(device_range("joint/MaxAcceleration")),
                   [](J& joint, double value) { joint.limits.max_acceleration = value; }));
  add(joint_setter("Device.Machine_SetMechanismJntMaxJerk",
                   "Wanted largest jerk of a joint. Acts with the next Machine_ConfigureMotionPlanner.",
                   number("MaxJntJerk", "mm/s³ or deg/s³").within(device_range("joint/MaxJerk")),
                   [](J& joint, double value) { joint.limits.max_jerk = value; }));
  add(method(
          "Device.Machine_ConfigureMotionPlanner",
          "The driver configures the motion planner by the wanted values: joints, limits, largest feed and speeds, at "
          "standstill; or nothing changes.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .prepared_by([](Call& call) { return call.machine.device().configuring(); })
          .does([](Call& call) { return call.machine.device().configure_motion_planner(); }));
  add(method("Device.Machine_ConfigureServoController",
             "The driver puts the database's control methods, servo laws, gains and bounds of the following error back "
             "in, at standstill, whatever RMAC_Config made of them; or nothing changes. What the setters ask for waits "
             "for Machine_ConfigureMotionPlanner.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .does([](Call& call) { return call.machine.device().configure_servo_controller(); }));
  add(method("Device.Machine_ConfigureDigitalControlInterface",
             "The driver puts the database's interfaces to drives and I/O back in, at standstill, whatever RMAC_Config "
             "made of them; or nothing changes.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .does([](Call& call) { return call.machine.device().configure_digital_control_interface(); }));
}

}  // namespace rmac::gateway
