// RMAC_Config.*: the draft of a mechanism (Appendix IV). Nothing acts before RMAC_Config.Apply.
#include <algorithm>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "rmac/motion/servo_loop.hpp"

namespace rmac::gateway {

namespace {

using sdk::ModuleChoice;
using sdk::RmacConfig;

/// The laws themselves know narrower ones, which Apply holds their parameters to.
constexpr Range kLawParameters{-1e6, 1e6};

/// A module of this name; naming the one that the draft has already keeps its parameters.
ModuleChoice chosen(const ModuleChoice& present, const std::string& name) {
  if (present.name == name) return present;
  return ModuleChoice{name, {}, {}};
}

/// Of a joint or a held one; none where there is no such joint, which the setter says.
ModuleChoice law_of(const sdk::DeviceObject& draft, std::int64_t joint) {
  const auto index = static_cast<std::size_t>(joint);
  const std::size_t moved = draft.joints.size();
  if (index < moved) return draft.joints[index].servo_law;
  return index - moved < draft.held_joints.size() ? draft.held_joints[index - moved].servo_law : ModuleChoice{};
}

template <typename Function>
Method joint_number_setter(const char* name, const char* meaning, Parameter<double> value, Function function) {
  return method(name, meaning)
      .takes(joint_number(), std::move(value))
      .needs(Permission::Authority)
      .does([function](Call& call, std::int64_t joint, double wanted) {
        return (call.machine.config().*function)(static_cast<int>(joint), wanted);
      });
}

template <typename Function>
Method count_setter(const char* name, const char* meaning, Parameter<std::int64_t> parameter, Function function) {
  return method(name, meaning)
      .takes(std::move(parameter))
      .needs(Permission::Authority)
      .does([function](Call& call, std::int64_t count) {
        return (call.machine.config().*function)(static_cast<int>(count));
      });
}

template <typename Function>
Method module_setter(const char* name, const char* meaning, const char* parameter,
                     ModuleChoice sdk::DeviceObject::*present, Function function) {
  return method(name, meaning)
      .takes(text(parameter).noted("name of a module"))
      .needs(Permission::Authority)
      .does([function, present](Call& call, const std::string& module) {
        RmacConfig& config = call.machine.config();
        return (config.*function)(chosen(config.draft().*present, module));
      });
}

void add_joint_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismJointType", "Whether a joint turns, slides or screws.")
          .takes(joint_number(), choice("JointType", kJointTypeValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t type) {
            return call.machine.config().set_joint_type(static_cast<int>(joint), static_cast<JointType>(type));
          }));
  add(method("RMAC_Config.SetMechanismJointLimitType", "On which sides a joint's travel ends.")
          .takes(joint_number(), choice("JointLimitType", kJointLimitTypeValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t type) {
            return call.machine.config().set_joint_limit_type(static_cast<int>(joint),
                                                              static_cast<JointLimitType>(type));
          }));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumLimit", "Upper end of a joint's travel.",
                          number("MaxJntLimit", "mm or deg").within(device_range("joint/Max")),
                          &RmacConfig::set_joint_maximum_limit));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMinimumLimit", "Lower end of a joint's travel.",
                          number("MinJntLimit", "mm or deg").within(device_range("joint/Min")),
                          &RmacConfig::set_joint_minimum_limit));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumSpeed", "Largest speed of a joint.",
                          number("MaxJntSpeed", "mm/s or deg/s").within(device_range("joint/MaxSpeed")),
                          &RmacConfig::set_joint_maximum_speed));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumAcceleration", "Largest acceleration of a joint.",
                          number("MaxJntAccel", "mm/s² or deg/s²").within(device_range("joint/MaxAcceleration")),
                          &RmacConfig::set_joint_maximum_acceleration));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumJerk", "Largest jerk of a joint.",
                          number("MaxJntJerk", "mm/s³ or deg/s³").within(device_range("joint/MaxJerk")),
                          &RmacConfig::set_joint_maximum_jerk));
}

void add_servo_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismJointControlMethod", "What a joint's servo loop controls.")
          .takes(joint_number(), choice("DMACServoControlMethod", kControlMethodValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t method) {
            return call.machine.config().set_joint_control_method(static_cast<int>(joint),
                                                                  static_cast<ControlMethod>(method));
          }));
  add(method("RMAC_Config.SetMechanismJointServoControlGains", "Gains of a joint's servo law, in the law's own order.")
          .takes(joint_number(),
                 numbers("ServoControlGains", "as the law declares").within(device_range("joint/Gains")))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, const std::vector<double>& gains) {
            return call.machine.config().set_joint_servo_control_gains(static_cast<int>(joint), gains);
          }));
  add(method("RMAC_Config.SetMechanismJointServoControlLaw", "Servo law of a joint.")
          .takes(joint_number(), text("ControlLaw")
                                     .noted("DMAC_PID_CONTROL or another constant of Appendix IV, or "
                                            "the name of a module"))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, const std::string& law) {
            RmacConfig& config = call.machine.config();
            return config.set_joint_servo_control_law(static_cast<int>(joint),
                                                      chosen(law_of(config.draft(), joint), law));
          }));
  add(method("RMAC_Config.SetMechanismJointServoControlParameter",
             "A parameter of a joint's servo law beside its gains: lead_s, rest_band, … Another law forgets it.")
          .takes(joint_number(), text("Name").noted("as docs/servo.md has it"),
                 number("Value", "as the law declares").within(kLawParameters))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t joint, const std::string& name, double value) -> Expected<> {
            RmacConfig& config = call.machine.config();
            ModuleChoice law = law_of(config.draft(), joint);
            law.numbers[name] = {value};
            return config.set_joint_servo_control_law(static_cast<int>(joint), law);
          }));
}

/// The dissertation's setters of spindles name none: they are of every one.
template <typename Set>
Expected<> for_each_spindle(Call& call, Set set) {
  const auto count = std::max<std::size_t>(1, call.machine.config().draft().spindles.size());
  for (std::size_t spindle = 0; spindle < count; ++spindle) {
    // Where there is none, the first says so.
    if (auto done = set(call.machine.config(), static_cast<int>(spindle)); !done) return done;
  }
  return {};
}

void add_spindle_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismSpindleMaxRPM", "Largest speed of every spindle.")
          .takes(number("MaxSpindleRPM", "rpm").within(device_range("spindle/MaxSpeed")).at_least(1))
          .needs(Permission::Authority)
          .does([](Call& call, double rpm) {
            return for_each_spindle(
                call, [rpm](RmacConfig& config, int spindle) { return config.set_spindle_maximum_rpm(spindle, rpm); });
          }));
  add(method("RMAC_Config.SetMechanismSpindleControlMethod",
             "What the servo loop of every spindle controls: its speed, or its angle where its drive takes a torque.")
          .takes(choice("DMACServoControlMethod", kControlMethodValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t method) {
            return for_each_spindle(call, [method](RmacConfig& config, int spindle) {
              return config.set_spindle_control_method(spindle, static_cast<ControlMethod>(method));
            });
          }));
  add(method("RMAC_Config.SetMechanismSpindleServoControlLaw",
             "Servo law of every spindle, whose drives must take a torque; none where they follow speeds themselves.")
          .takes(text("ControlLaw")
                     .noted("DMAC_PID_CONTROL or another constant of Appendix IV, the name of a module, or "
                            "empty for none"))
          .needs(Permission::Authority)
          .does([](Call& call, const std::string& law) {
            return for_each_spindle(call, [&law](RmacConfig& config, int spindle) {
              const auto& spindles = config.draft().spindles;
              const auto index = static_cast<std::size_t>(spindle);
              return config.set_spindle_servo_control_law(spindle, index < spindles.size()
                                                                       ? chosen(spindles[index].servo_law, law)
                                                                       : ModuleChoice{law, {}, {}});
            });
          }));
  add(method("RMAC_Config.SetMechanismSpindleServoControlGains",
             "Gains of the servo law of every spindle, in the law's own order.")
          .takes(numbers("ServoControlGains", "as the law declares").within(device_range("joint/Gains")))
          .needs(Permission::Authority)
          .does([](Call& call, const std::vector<double>& gains) {
            return for_each_spindle(call, [&gains](RmacConfig& config, int spindle) {
              return config.set_spindle_servo_control_gains(spindle, gains);
            });
          }));
}

void add_interface_setters(const auto& add) {
  using sdk::DeviceObject;
  add(module_setter("RMAC_Config.SetMechanismDigitalControlInterface",
                    "Interface to the drives. Apply brings them down and up again, because two cannot run one bus.",
                    "DigitalControlInterface", &DeviceObject::digital_control_interface,
                    &RmacConfig::set_digital_control_interface));
  add(method("RMAC_Config.InitializeMechanismDigitalControlInterface", "Brings the interface to the drives up.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does([](Call& call) { return call.machine.config().initialize_digital_control_interface(); }));
  add(module_setter("RMAC_Config.SetMechanismDigitalIOInterface", "Interface to inputs and outputs.",
                    "DigitalIOInterface", &DeviceObject::digital_io_interface, &RmacConfig::set_digital_io_interface));
  add(method("RMAC_Config.InitializeMechanismDigitalIOInterface", "Brings the interface to inputs and outputs up.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does([](Call& call) { return call.machine.config().initialize_digital_io_interface(); }));
}

}  // namespace

void add_config_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  using sdk::DeviceObject;
  add(module_setter("RMAC_Config.SetMechanismKinematics", "Module that computes the kinematics.", "DMACKin",
                    &DeviceObject::kinematics, &RmacConfig::set_kinematics));
  add(module_setter("RMAC_Config.SetMechanismActuatorMap", "Module that maps joints to actuators.", "DMACMachineActMap",
                    &DeviceObject::actuator_map, &RmacConfig::set_actuator_map));
  add(count_setter("RMAC_Config.SetMechanismNumJnts", "Number of joints that the mechanism moves.",
                   integer("NumJnts").within(1, kMaxJoints), &RmacConfig::set_number_of_joints));
  add(count_setter("RMAC_Config.SetMechanismNumSpindle", "Number of spindles.",
                   integer("NumSpindle").within(0, kMaxSpindles), &RmacConfig::set_number_of_spindles));
  add(count_setter("RMAC_Config.SetMechanismNumActuators", "Number of actuators behind joints and held joints.",
                   integer("NumActuators").within(1, kMaxJoints), &RmacConfig::set_number_of_actuators));
  add(method("RMAC_Config.SetMechanismMaxFeedrate", "Largest feed of the mechanism.")
          .takes(number("MaxFeedrate", "mm/min").within(device_range("MaxFeedrate")))
          .needs(Permission::Authority)
          .does([](Call& call, double feed) { return call.machine.config().set_maximum_feedrate(feed); }));
  add_joint_setters(add);
  add_servo_setters(add);
  add_spindle_setters(add);
  add_interface_setters(add);
  add(method("RMAC_Config.Apply",
             "Checks the draft as a whole and puts it in at standstill, or in motion too where servo laws of joints, "
             "their parameters and gains, and position or velocity as what is controlled, are all that changed; or "
             "changes nothing and says why.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .may_be_slow()
          .extension()
          .does([](Call& call) { return call.machine.config().apply(); }));
}

}  // namespace rmac::gateway
