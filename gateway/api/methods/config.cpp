// RMAC_Config.*: the draft of a mechanism (Appendix IV). Nothing acts before RMAC_Config.Apply.
#include <algorithm>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {

namespace {

using sdk::InterfaceConfig;
using sdk::JointConfig;
using sdk::MechanismConfig;
using sdk::ModuleChoice;
using sdk::RmacConfig;

/// The laws themselves know narrower ones, which Apply holds their parameters to.
constexpr Range kLawParameters{-1e6, 1e6};

/// A module of this name; naming the one that the draft has already keeps its parameters.
ModuleChoice chosen(const ModuleChoice& present, const std::string& name) {
  if (present.name == name) return present;
  return ModuleChoice{name, {}, {}};
}

/// The servo law that a joint has in the draft; none where there is no such joint, which the setter says.
ModuleChoice law_of(const sdk::DeviceObject& draft, std::int64_t joint) {
  const auto number = static_cast<std::size_t>(joint);
  return number < draft.joint_count_with_held() ? sdk::joint_at(draft, number).servo_law : ModuleChoice{};
}

template <typename Function>
Method joint_number_setter(const char* name, const char* meaning, Parameter<double> value, Function function) {
  return method(name, meaning)
      .takes(joint_number(), std::move(value))
      .needs(Permission::Authority)
      .does([function](Call& call, std::int64_t joint, double wanted) {
        return (call.machine.config().joints().*function)(static_cast<int>(joint), wanted);
      });
}

template <typename Function>
Method count_setter(const char* name, const char* meaning, Parameter<std::int64_t> parameter, Function function) {
  return method(name, meaning)
      .takes(std::move(parameter))
      .needs(Permission::Authority)
      .does([function](Call& call, std::int64_t count) {
        return (call.machine.config().mechanism().*function)(static_cast<int>(count));
      });
}

/// `function` is one of the part of RMAC_Config that `part` gives.
template <typename Part, typename Function>
Method module_setter(const char* name, const char* meaning, const char* parameter,
                     ModuleChoice sdk::DeviceObject::*present, Part part, Function function) {
  return method(name, meaning)
      .takes(text(parameter).noted("name of a module"))
      .needs(Permission::Authority)
      .does([part, function, present](Call& call, const std::string& module) {
        RmacConfig& config = call.machine.config();
        return ((config.*part)().*function)(chosen(config.draft().*present, module));
      });
}

void add_joint_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismJointType", "Whether a joint turns, slides or screws.")
          .takes(joint_number(), choice("JointType", kJointTypeValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t type) {
            return call.machine.config().joints().set_type(static_cast<int>(joint), static_cast<JointType>(type));
          }));
  add(method("RMAC_Config.SetMechanismJointLimitType", "On which sides a joint's travel ends.")
          .takes(joint_number(), choice("JointLimitType", kJointLimitTypeValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t type) {
            return call.machine.config().joints().set_limit_type(static_cast<int>(joint),
                                                                 static_cast<JointLimitType>(type));
          }));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumLimit", "Upper end of a joint's travel.",
                          number("MaxJntLimit", "mm or deg").within(device_range("joint/Max")),
                          &JointConfig::set_maximum_limit));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMinimumLimit", "Lower end of a joint's travel.",
                          number("MinJntLimit", "mm or deg").within(device_range("joint/Min")),
                          &JointConfig::set_minimum_limit));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumSpeed", "Largest speed of a joint.",
                          number("MaxJntSpeed", "mm/s or deg/s").within(device_range("joint/MaxSpeed")),
                          &JointConfig::set_maximum_speed));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumAcceleration", "Largest acceleration of a joint.",
                          number("MaxJntAccel", "mm/s² or deg/s²").within(device_range("joint/MaxAcceleration")),
                          &JointConfig::set_maximum_acceleration));
  add(joint_number_setter("RMAC_Config.SetMechanismJointMaximumJerk", "Largest jerk of a joint.",
                          number("MaxJntJerk", "mm/s³ or deg/s³").within(device_range("joint/MaxJerk")),
                          &JointConfig::set_maximum_jerk));
}

void add_servo_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismJointControlMethod", "What a joint's servo loop controls.")
          .takes(joint_number(), choice("DMACServoControlMethod", kControlMethodValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, std::int64_t method) {
            return call.machine.config().loops().set_control_method(static_cast<int>(joint),
                                                                    static_cast<ControlMethod>(method));
          }));
  add(method("RMAC_Config.SetMechanismJointServoControlGains", "Gains of a joint's servo law, in the law's own order.")
          .takes(joint_number(),
                 numbers("ServoControlGains", "as the law declares").within(device_range("joint/Gains")))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, const std::vector<double>& gains) {
            return call.machine.config().loops().set_gains(static_cast<int>(joint), gains);
          }));
  add(method("RMAC_Config.SetMechanismJointServoControlLaw", "Servo law of a joint.")
          .takes(joint_number(), text("ControlLaw")
                                     .noted("DMAC_PID_CONTROL or another constant of Appendix IV, or "
                                            "the name of a module"))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, const std::string& law) {
            RmacConfig& config = call.machine.config();
            return config.loops().set_servo_law(static_cast<int>(joint), chosen(law_of(config.draft(), joint), law));
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
            return config.loops().set_servo_law(static_cast<int>(joint), law);
          }));
}

/// The dissertation's setters of spindles name none: they set every one.
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
            return for_each_spindle(call, [rpm](RmacConfig& config, int spindle) {
              return config.spindles().set_maximum_rpm(spindle, rpm);
            });
          }));
  add(method("RMAC_Config.SetMechanismSpindleControlMethod",
             "What the servo loop of every spindle controls: its speed, or its angle where its drive takes a torque.")
          .takes(choice("DMACServoControlMethod", kControlMethodValues))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t method) {
            return for_each_spindle(call, [method](RmacConfig& config, int spindle) {
              return config.spindles().set_control_method(spindle, static_cast<ControlMethod>(method));
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
              return config.spindles().set_servo_law(spindle, index < spindles.size()
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
              return config.spindles().set_gains(spindle, gains);
            });
          }));
}

void add_interface_setters(const auto& add) {
  using sdk::DeviceObject;
  add(module_setter("RMAC_Config.SetMechanismDigitalControlInterface",
                    "Interface to the drives. Apply brings them down and up again, because two cannot run one bus.",
                    "DigitalControlInterface", &DeviceObject::digital_control_interface, &RmacConfig::interfaces,
                    &InterfaceConfig::set_control));
  add(method("RMAC_Config.InitializeMechanismDigitalControlInterface", "Brings the interface to the drives up.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does([](Call& call) { return call.machine.config().interfaces().initialize_control(); }));
  add(module_setter("RMAC_Config.SetMechanismDigitalIOInterface", "Interface to inputs and outputs.",
                    "DigitalIOInterface", &DeviceObject::digital_io_interface, &RmacConfig::interfaces,
                    &InterfaceConfig::set_io));
  add(method("RMAC_Config.InitializeMechanismDigitalIOInterface", "Brings the interface to inputs and outputs up.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does([](Call& call) { return call.machine.config().interfaces().initialize_io(); }));
}

}  // namespace

void add_config_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  using sdk::DeviceObject;
  add(module_setter("RMAC_Config.SetMechanismKinematics", "Module that computes the kinematics.", "DMACKin",
                    &DeviceObject::kinematics, &RmacConfig::mechanism, &MechanismConfig::set_kinematics));
  add(module_setter("RMAC_Config.SetMechanismActuatorMap", "Module that maps joints to actuators.", "DMACMachineActMap",
                    &DeviceObject::actuator_map, &RmacConfig::mechanism, &MechanismConfig::set_actuator_map));
  add(count_setter("RMAC_Config.SetMechanismNumJnts", "Number of joints that the mechanism moves.",
                   integer("NumJnts").within(1, kMaxJoints), &MechanismConfig::set_number_of_joints));
  add(count_setter("RMAC_Config.SetMechanismNumSpindle", "Number of spindles.",
                   integer("NumSpindle").within(0, kMaxSpindles), &MechanismConfig::set_number_of_spindles));
  add(count_setter("RMAC_Config.SetMechanismNumActuators", "Number of actuators behind joints and held joints.",
                   integer("NumActuators").within(1, kMaxJoints), &MechanismConfig::set_number_of_actuators));
  add(method("RMAC_Config.SetMechanismMaxFeedrate", "Largest feed of the mechanism.")
          .takes(number("MaxFeedrate", "mm/min").within(device_range("MaxFeedrate")))
          .needs(Permission::Authority)
          .does([](Call& call, double feed) { return call.machine.config().mechanism().set_maximum_feedrate(feed); }));
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
