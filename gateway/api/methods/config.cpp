// RMAC_Config.*: the draft of a mechanism (Appendix IV). Nothing acts before RMAC_Config.Apply.
#include <algorithm>
#include <utility>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"
#include "gateway/device_database/device_parts.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {

namespace {

using sdk::DeviceObject;
using sdk::InterfaceConfig;
using sdk::JointConfig;
using sdk::MechanismConfig;
using sdk::ModuleChoice;
using sdk::RmacConfig;

/// The laws themselves know narrower ones, which Apply holds their parameters to.
constexpr Range kLawParameters{-1e6, 1e6};

/// A module's parameters, as they stand in device.json.
using Parameters = std::optional<JsonValue>;

auto parameters() {
  return object("Parameters")
      .optional()
      .noted(
          "its parameters, as in device.json; left out, a module that was chosen already keeps those it has, and "
          "another has none");
}

/// A module of this name.
Expected<ModuleChoice> chosen(const ModuleChoice& present, const std::string& name, const Parameters& parameters) {
  ModuleChoice choice = present.name == name && !parameters ? present : ModuleChoice{name, {}, {}};
  if (!parameters) return choice;
  return read_parameters(parameters->json, choice).map([&] { return choice; }).map_error([](const Error& error) {
    return Error{error.code, "Parameters: " + error.message};
  });
}

/// The servo law that a joint has in the draft; none where there is no such joint, which the setter says.
ModuleChoice law_of(const sdk::DeviceObject& draft, std::int64_t joint) {
  const auto number = static_cast<std::size_t>(joint);
  return number < draft.joint_count_with_held() ? sdk::joint_at(draft, number).servo_law : ModuleChoice{};
}

/// The mechanics that a joint has in the draft; none where there is no such joint, which the setter says.
JointMechanics mechanics_of(const sdk::DeviceObject& draft, std::int64_t joint) {
  const auto number = static_cast<std::size_t>(joint);
  return number < draft.joint_count_with_held() ? sdk::joint_at(draft, number).mechanics : JointMechanics{};
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

/// Sets how many there are of something that hangs on buses, and, where `Buses` tells it, where each hangs. `entries`
/// names the list of device.json that `Buses` is like.
template <typename SetCount, typename SetBuses>
Method count_setter(const char* name, const char* meaning, Parameter<std::int64_t> parameter, const char* entries,
                    SetCount set_count, SetBuses set_buses) {
  const std::string count_name = parameter.spec.name;
  return method(name, meaning)
      .takes(std::move(parameter),
             objects("Buses").optional().noted(
                 fmt::format("for each its `Bus`, `Axis` and what else {} of device.json have (but for `Inputs`); what "
                             "is left out stays as it is",
                             entries)))
      .needs(Permission::Authority)
      .does([=](Call& call, std::int64_t count, const std::optional<JsonValue>& buses) -> Expected<> {
        RmacConfig& config = call.machine.config();
        if (!buses) return set_count(config.mechanism(), static_cast<int>(count));
        if (std::cmp_not_equal(buses->json.size(), count)) {
          return failure(MinorCode::InvalidParameterValue,
                         fmt::format("Buses: there are {} for a {} of {}", buses->json.size(), count_name, count));
        }
        return set_buses(config, buses->json).map_error([](const Error& error) {
          return Error{error.code, "Buses: " + error.message};
        });
      });
}

/// `function` is one of the part of RMAC_Config that `part` gives.
template <typename Part, typename Function>
Method module_setter(const char* name, const char* meaning, const char* parameter,
                     ModuleChoice sdk::DeviceObject::*present, Part part, Function function) {
  return method(name, meaning)
      .takes(text(parameter).noted("name of a module"), parameters())
      .needs(Permission::Authority)
      .does([part, function, present](Call& call, const std::string& module, const Parameters& parameters) {
        RmacConfig& config = call.machine.config();
        return chosen(config.draft().*present, module, parameters).and_then([&](const ModuleChoice& choice) {
          return ((config.*part)().*function)(choice);
        });
      });
}

void add_joint_setters(const auto& add) {
  add(method("RMAC_Config.SetMechanismJointName", "Name of a joint; every joint has one of its own.")
          .takes(joint_number(), text("Name"))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t joint, const std::string& name) {
            return call.machine.config().joints().set_name(static_cast<int>(joint), name);
          }));
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
          .takes(joint_number(),
                 text("ControlLaw")
                     .noted("DMAC_PID_CONTROL or another constant of Appendix IV, or "
                            "the name of a module"),
                 parameters())
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t joint, const std::string& law, const Parameters& parameters) {
            RmacConfig& config = call.machine.config();
            return chosen(law_of(config.draft(), joint), law, parameters).and_then([&](const ModuleChoice& choice) {
              return config.loops().set_servo_law(static_cast<int>(joint), choice);
            });
          }));
  add(method("RMAC_Config.SetMechanismJointWatch",
             "How far a joint may fall behind, and how hard it may be driven, before the machine stops.")
          .takes(joint_number(),
                 number("MaxFollowingError", "mm or deg").within(device_range("joint/MaxFollowingError")),
                 number("MaxEffort", "N or N·m").within(device_range("joint/MaxEffort")))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t joint, double max_following_error, double max_effort) {
            return call.machine.config().loops().set_watch(static_cast<int>(joint), max_following_error, max_effort);
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
  add(method("RMAC_Config.SetMechanismJointFilters",
             "Filters of a joint's effort: a notch for each resonance, and a low-pass. They take the place of those "
             "that it has.")
          .takes(joint_number(), number("LowPass", "Hz").within(device_range("joint/LowPass")).noted("0 for none"),
                 objects("Resonances").noted("as in device.json; [] for none"))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t joint, double low_pass_hz, const JsonValue& list) {
            RmacConfig& config = call.machine.config();
            return read_resonances(list.json)
                .map_error([](const Error& error) {
                  return Error{error.code, "Resonances: " + error.message};
                })
                .and_then([&](std::vector<Resonance> resonances) {
                  JointMechanics mechanics = mechanics_of(config.draft(), joint);
                  mechanics.resonances = std::move(resonances);
                  mechanics.low_pass_hz = low_pass_hz;
                  return config.loops().set_mechanics(static_cast<int>(joint), mechanics);
                });
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
                            "empty for none"),
                 parameters())
          .needs(Permission::Authority)
          .does([](Call& call, const std::string& law, const Parameters& parameters) {
            return for_each_spindle(call, [&](RmacConfig& config, int spindle) {
              const auto& spindles = config.draft().spindles;
              const auto index = static_cast<std::size_t>(spindle);
              return chosen(index < spindles.size() ? spindles[index].servo_law : ModuleChoice{}, law, parameters)
                  .and_then(
                      [&](const ModuleChoice& choice) { return config.spindles().set_servo_law(spindle, choice); });
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
  add(module_setter("RMAC_Config.SetMechanismDigitalControlInterface",
                    "Interface to the drives. Apply brings them down and up again, because two cannot run one bus.",
                    "DigitalControlInterface", &DeviceObject::digital_control_interface, &RmacConfig::interfaces,
                    &InterfaceConfig::set_control));
  add(method("RMAC_Config.InitializeMechanismDigitalControlInterface",
             "Checks that the interface to the drives can be made with its parameters; Apply brings it up.")
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .does([](Call& call) { return call.machine.config().interfaces().initialize_control(); }));
  add(module_setter("RMAC_Config.SetMechanismDigitalIOInterface", "Interface to inputs and outputs.",
                    "DigitalIOInterface", &DeviceObject::digital_io_interface, &RmacConfig::interfaces,
                    &InterfaceConfig::set_io));
  add(method("RMAC_Config.InitializeMechanismDigitalIOInterface",
             "Checks that the interface to inputs and outputs can be made with its parameters; Apply brings it up.")
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
  add(method("RMAC_Config.SetMechanismNumJnts",
             "Number of joints that the mechanism moves. One that comes is as device.json has it, or waits for its "
             "setters.")
          .takes(integer("NumJnts").within(1, kMaxJoints))
          .needs(Permission::Authority)
          .does([](Call& call, std::int64_t count) {
            return call.machine.config().mechanism().set_number_of_joints(static_cast<int>(count));
          }));
  add(count_setter(
      "RMAC_Config.SetMechanismNumSpindle", "Number of spindles.", integer("NumSpindle").within(0, kMaxSpindles),
      "Spindles", [](MechanismConfig& mechanism, int count) { return mechanism.set_number_of_spindles(count); },
      [](RmacConfig& config, const nlohmann::json& list) {
        return read_spindles(list, config.draft().spindles).and_then([&](const std::vector<sdk::Spindle>& spindles) {
          return config.mechanism().set_spindles(spindles);
        });
      }));
  add(count_setter(
      "RMAC_Config.SetMechanismNumActuators", "Number of actuators behind joints and held joints.",
      integer("NumActuators").within(1, kMaxJoints), "Actuators",
      [](MechanismConfig& mechanism, int count) { return mechanism.set_number_of_actuators(count); },
      [](RmacConfig& config, const nlohmann::json& list) {
        return read_actuators(list, config.draft().actuators)
            .and_then([&](const std::vector<sdk::Actuator>& actuators) {
              return config.mechanism().set_actuators(actuators);
            });
      }));
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
          .prepared_by([](Call& call) { return call.machine.device().applying(); })
          .does([](Call& call) { return call.machine.config().apply(); }));
}

}  // namespace rmac::gateway
