#include "gateway/mechanism/assembler.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "gateway/buses/bus_choice.hpp"
#include "gateway/buses/simulated_io.hpp"
#include "gateway/mechanism/exchangeable_law.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::gateway {
namespace {

/// What is not declared follows from the joint's speed. A word of a drive that comes a cycle late makes one step of its
/// position up to twice that speed short or long; a jump is what that cannot explain.
JointBounds bounds(const sdk::Joint& joint, double period_s) {
  constexpr double kSpeedShare = 1.2, kJumpCycles = 3;
  const double speed = joint.limits.max_speed;
  const double no_end = std::numeric_limits<double>::infinity();
  return {.velocity = joint.max_measured_speed > 0 ? joint.max_measured_speed : kSpeedShare * speed,
          .jump = joint.max_jump > 0 ? joint.max_jump : kJumpCycles * speed * period_s,
          .stop_deceleration = joint.limits.max_acceleration,
          .min_position = ends_below(joint.limits) ? joint.limits.min : -no_end,
          .max_position = ends_above(joint.limits) ? joint.limits.max : no_end};
}

ForceControl force(const sdk::Joint& joint) {
  ForceControl result = joint.force.value_or(ForceControl{});
  result.max_acceleration = joint.limits.max_acceleration;
  return result;
}

/// The law that is named, with these gains.
Expected<std::shared_ptr<ServoLaw>> load_law(const sdk::ModuleChoice& choice, const std::vector<double>& gains,
                                             const std::string& who, const ModuleLoader& loader,
                                             std::vector<ModuleInUse>& modules) {
  const std::string name = sdk::servo_law_module(choice.name);
  auto law = loader.load<ServoLaw>({name, choice.numbers, choice.texts});
  if (!law) return tl::unexpected(law.error());
  if (!law->object->set_gains(gains)) {
    std::string wanted;
    for (const GainInfo& gain : law->object->gains()) {
      wanted += fmt::format("{}{} ({})", wanted.empty() ? "" : ", ", gain.name, gain.unit);
    }
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} does not accept the gains [{}]; it takes {}: {}", who, name,
                               fmt::join(gains, ", "), law->object->gains().size(), wanted));
  }
  modules.push_back({"servo control law of " + who, name, law->build_id});
  return std::move(law->object);
}

Expected<ServoJoint> make_axis(const sdk::Joint& joint, const ModuleLoader& loader, double period_s,
                               std::vector<ModuleInUse>& modules) {
  ServoJoint axis{nullptr,          joint.method,    joint.max_following_error,
                  joint.max_effort, joint.mechanics, bounds(joint, period_s),
                  std::nullopt,     force(joint)};
  if (joint.servo_law.name.empty()) return axis;
  auto law = load_joint_law(joint, loader, modules);
  if (!law) return tl::unexpected(law.error());
  axis.law = std::make_shared<ExchangeableLaw>(std::move(*law));
  return axis;
}

Expected<> add_axes(const sdk::DeviceObject& device, const ModuleLoader& loader, ServoLoopParts& parts,
                    std::vector<ModuleInUse>& modules) {
  for (const auto* joints : {&device.joints, &device.held_joints}) {
    for (const sdk::Joint& joint : *joints) {
      auto axis = make_axis(joint, loader, parts.period_s, modules);
      if (!axis) return tl::unexpected(axis.error());
      parts.joints.push_back(std::move(*axis));
      parts.virtual_start.push_back(joint.limits.limit_type == JointLimitType::Limited
                                        ? std::clamp(0.0, joint.limits.min, joint.limits.max)
                                        : 0.0);
    }
  }
  return {};
}

/// The bus of a drive, brought up.
Expected<std::shared_ptr<ServoBus>> bus_of(const std::string& who, const std::string& name, std::uint32_t axis,
                                           const sdk::DeviceObject& device, const ModuleLoader& loader,
                                           BusRegistry& registry, bool virtual_mode) {
  if (virtual_mode) return registry.virtual_bus(name);
  auto bus = registry.acquire(name, interface_of_bus(name, device.digital_control_interface), loader);
  if (!bus) return bus;
  if (const std::size_t there = (*bus)->interface->axis_count(); axis >= there) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: bus {} has no axis {}; it has {}", who, name, axis, there));
  }
  return bus;
}

Expected<> add_drives(const sdk::DeviceObject& device, const ModuleLoader& loader, BusRegistry& registry,
                      ServoLoopParts& parts) {
  for (const sdk::Actuator& actuator : device.actuators) {
    auto bus = bus_of(fmt::format("actuator {}", parts.actuators.size()), actuator.bus, actuator.axis, device, loader,
                      registry, parts.virtual_mode);
    if (!bus) return tl::unexpected(bus.error());
    const DigitalControlInterface& interface = *(*bus)->interface;
    constexpr double kTorqueShare = 3.5;
    const double max_torque = actuator.max_measured_torque_nm > 0 ? actuator.max_measured_torque_nm
                                                                  : kTorqueShare * actuator.scale.rated_torque_nm;
    constexpr double kSameScale = 1e-6;
    const double told = parts.virtual_mode ? 0 : interface.counts_per_revolution(actuator.axis);
    if (const double meant = actuator.scale.counts_per_revolution;
        told > 0 && std::abs(meant / told - 1) > kSameScale) {
      return failure(MinorCode::Scale,
                     fmt::format("actuator {}: its drive (bus {}, axis {}) counts {:.10g} in a turn of the motor, and "
                                 "CountsPerRevolution is {:.10g}; set one of them right",
                                 parts.actuators.size(), actuator.bus, actuator.axis, told, meant));
    }
    const bool latches =
        parts.virtual_mode || !actuator.probe_edge || interface.latches(actuator.axis, *actuator.probe_edge);
    if (!latches) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("actuator {}: a touch probe of its drive is to latch its position, and bus {} does "
                                 "not carry that for axis {}; leave TouchProbe out, or have its words carried",
                                 parts.actuators.size(), actuator.bus, actuator.axis));
    }
    const DriveMode mode = parts.virtual_mode ? DriveMode::CyclicSyncTorque : interface.mode(actuator.axis);
    const double gain = parts.virtual_mode ? 0 : actuator.position_gain;
    parts.actuators.push_back({std::move(*bus), actuator.axis, actuator.scale,
                               static_cast<std::uint8_t>(actuator.homing_turn), max_torque, mode, gain,
                               actuator.probe_edge});
  }
  return {};
}

Expected<> add_spindles(const sdk::DeviceObject& device, const ModuleLoader& loader, BusRegistry& registry,
                        ServoLoopParts& parts, std::vector<ModuleInUse>& modules) {
  for (const sdk::Spindle& spindle : device.spindles) {
    const std::string who = fmt::format("spindle {}", parts.spindles.size());
    auto bus = bus_of(who, spindle.bus, spindle.axis, device, loader, registry, parts.virtual_mode);
    if (!bus) return tl::unexpected(bus.error());
    std::shared_ptr<ServoLaw> law;
    if (!spindle.servo_law.name.empty()) {
      auto loaded = load_law(spindle.servo_law, spindle.gains, who, loader, modules);
      if (!loaded) return tl::unexpected(loaded.error());
      law = std::move(*loaded);
    }
    ServoSpindle part{.bus = std::move(*bus), .axis = spindle.axis, .max_speed_rpm = spindle.max_speed_rpm};
    if (!parts.virtual_mode) {
      const DigitalControlInterface& interface = *part.bus->interface;
      const std::string drive = fmt::format("{} (bus {}, axis {})", who, spindle.bus, spindle.axis);
      if (spindle.scale.rated_torque_nm > 0 && !interface.tells_torque(spindle.axis)) {
        return failure(
            MinorCode::InvalidParameterValue,
            fmt::format("{}: RatedTorque is given, and its drive tells no torque here; leave it out, or have "
                        "6077h carried",
                        drive));
      }
      part.mode = interface.mode(spindle.axis);
      part.law = std::move(law);
      part.method = spindle.method;
      part.scale = spindle.scale;
      part.max_acceleration_rpm_s = spindle.max_acceleration_rpm_s;
      part.max_following_error_deg = spindle.max_following_error_deg;
      part.max_torque_nm = spindle.max_torque_nm;
      part.speed_tolerance_rpm = spindle.speed_tolerance_rpm;
      part.speed_timeout_s = spindle.speed_timeout_s;
      if (auto fine = check_spindle(part, drive); !fine) return fine;
    }
    parts.spindles.push_back(std::move(part));
  }
  return {};
}

/// A sensor's word comes with those of a bus that the mechanism's drives are on, or of one of its own.
Expected<> add_sensors(const sdk::DeviceObject& device, const ModuleLoader& loader, BusRegistry& registry,
                       ServoLoopParts& parts) {
  if (parts.virtual_mode) return {};
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const std::size_t moved = device.joints.size();
    const sdk::Joint& joint = j < moved ? device.joints[j] : device.held_joints[j - moved];
    if (!joint.force_sensor) continue;
    const sdk::ForceSensor& sensor = *joint.force_sensor;
    auto bus = registry.acquire(sensor.bus, interface_of_bus(sensor.bus, device.digital_control_interface), loader);
    if (!bus) return tl::unexpected(bus.error());
    if (const std::size_t there = (*bus)->interface->axis_count(); sensor.axis >= there) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("force sensor of joint \"{}\": bus {} has no axis {}; it has {}", joint.limits.name,
                                 sensor.bus, sensor.axis, there));
    }
    parts.joints[j].force_sensor =
        ServoForceSensor{std::move(*bus), sensor.axis, sensor.newton_per_count, sensor.zero_counts};
  }
  return {};
}

/// Names of inputs on which the servo loop acts by itself.
constexpr std::string_view kEmergencyStop = "EmergencyStop", kLimit = "Limit";
/// Names of those that a touch probe is wired to.
constexpr const char *kProbe = "Probe", *kProbeReady = "ProbeReady";

std::uint64_t named(const std::map<std::string, int>& names, std::string_view prefix) {
  std::uint64_t bits = 0;
  for (const auto& [name, bit] : names) bits |= name.starts_with(prefix) ? std::uint64_t{1} << bit : 0;
  return bits;
}

Expected<> check_bits(const std::map<std::string, int>& names, const std::string& what, std::uint64_t there,
                      const std::string& interface) {
  for (const auto& [name, bit] : names) {
    if ((there >> bit & 1U) != 0) continue;
    std::vector<int> bits;
    for (int i = 0; i < 64; ++i) {
      if ((there >> i & 1U) != 0) bits.push_back(i);
    }
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} \"{}\" is bit {}, to which nothing of {} is connected; connected are {}", what, name,
                               bit, interface, bits.empty() ? "none" : fmt::format("{}", fmt::join(bits, ", "))));
  }
  return {};
}

Expected<> add_io_interface(const sdk::DeviceObject& device, const ModuleLoader& loader, BusRegistry& registry,
                            ServoLoopParts& parts) {
  if (device.digital_io_interface.name.empty()) return {};
  auto io = registry.acquire_io(device.digital_io_interface, loader);
  if (!io) return tl::unexpected(io.error());
  const std::string& name = device.digital_io_interface.name;
  auto inputs = device.inputs;
  std::erase_if(inputs, [&](const auto& input) { return device.drive_inputs.contains(input.second); });
  auto connected = check_bits(inputs, "input", (*io)->input_bits(), name).and_then([&] {
    return check_bits(device.outputs, "output", (*io)->output_bits(), name);
  });
  if (!connected) return connected;
  auto probed = with_touch_probe(std::move(*io), parts);
  if (!probed) return tl::unexpected(probed.error());
  parts.io = std::move(*probed);
  return {};
}

Expected<> add_drive_inputs(const sdk::DeviceObject& device, ServoLoopParts& parts) {
  for (const auto& [name, at] : device.inputs) {
    const auto told = device.drive_inputs.find(at);
    if (told == device.drive_inputs.end()) continue;
    const auto [actuator, bit] = told->second;
    if (actuator >= parts.actuators.size()) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("input \"{}\" is of actuator {}, and there are {}",
                                                                   name, actuator, parts.actuators.size()));
    }
    const ServoActuator& drive = parts.actuators[actuator];
    auto told_there = check_bits({{name, bit}}, fmt::format("input of actuator {}", actuator),
                                 drive.bus->interface->input_bits(drive.axis), "its drive's interface");
    if (!told_there) return told_there;
    parts.drive_inputs.push_back(
        {static_cast<std::uint32_t>(actuator), std::uint32_t{1} << bit, std::uint64_t{1} << at});
  }
  return {};
}

/// Switches whose names say the joint and the end: LimitXNegative, LimitXPositive.
std::vector<ServoLimit> limits_of(const sdk::DeviceObject& device) {
  std::vector<ServoLimit> limits;
  const auto add = [&](const std::string& joint, std::uint32_t number) {
    for (const auto& [end, direction] : {std::pair{"Negative", -1}, std::pair{"Positive", 1}}) {
      const auto found = device.inputs.find(fmt::format("{}{}{}", kLimit, joint, end));
      if (found != device.inputs.end()) limits.push_back({std::uint64_t{1} << found->second, number, direction});
    }
  };
  std::uint32_t number = 0;
  for (const auto* joints : {&device.joints, &device.held_joints}) {
    for (const sdk::Joint& joint : *joints) add(joint.limits.name, number++);
  }
  return limits;
}

Expected<> add_io(const sdk::DeviceObject& device, const ModuleLoader& loader, BusRegistry& registry,
                  ServoLoopParts& parts) {
  if (parts.virtual_mode) return {};
  auto added =
      add_io_interface(device, loader, registry, parts).and_then([&] { return add_drive_inputs(device, parts); });
  if (!added) return added;
  parts.limits = limits_of(device);
  parts.emergency_stop_inputs = named(device.inputs, kEmergencyStop);
  parts.limit_inputs = named(device.inputs, kLimit);
  const auto bit = [&](const char* input) {
    const auto found = device.inputs.find(input);
    return found == device.inputs.end() ? 0 : std::uint64_t{1} << found->second;
  };
  parts.probe = {bit(kProbe), bit(kProbeReady), device.probing.settle_time_s};
  return {};
}

const char* type_text(JointType type) {
  return type == JointType::Rotary ? "Rotary" : type == JointType::Linear ? "Linear" : "Screw";
}

/// A screw slides by what it counts. Its turn, about the axis along which it slides, is the geometry's business where
/// it moves the tool, and shows in none where the tool lies in that axis, as in a quill's.
bool fits(JointType configured, JointType built) {
  return configured == built || (configured == JointType::Screw && built == JointType::Linear);
}

Expected<> add_geometry(const sdk::DeviceObject& device, const ModuleLoader& loader, ServoLoopParts& parts,
                        std::vector<ModuleInUse>& modules) {
  auto kinematics = loader.load<Kinematics>(device.kinematics);
  if (!kinematics) return tl::unexpected(kinematics.error());
  if (kinematics->object->joint_count() != device.joints.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} has {} joints, but {} are configured", device.kinematics.name,
                               kinematics->object->joint_count(), device.joints.size()));
  }
  for (std::size_t i = 0; i < device.joints.size(); ++i) {
    const JointLimits& joint = device.joints[i].limits;
    if (const JointType built = kinematics->object->joint_type(i); !fits(joint.type, built)) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("joint {} \"{}\" is set to be {}, but it is {} in the geometry of {}", i, joint.name,
                                 type_text(joint.type), type_text(built), device.kinematics.name));
    }
  }
  auto map = loader.load<ActuatorMap>(device.actuator_map);
  if (!map) return tl::unexpected(map.error());
  const std::size_t axes = device.joints.size() + device.held_joints.size();
  if (map->object->joint_count() != axes || map->object->actuator_count() != device.actuators.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} maps {} joints to {} actuators, but {} joints (held ones included) and {} actuators "
                               "are configured",
                               device.actuator_map.name, map->object->joint_count(), map->object->actuator_count(),
                               axes, device.actuators.size()));
  }
  modules.push_back({"kinematics", device.kinematics.name, kinematics->build_id});
  modules.push_back({"actuator map", device.actuator_map.name, map->build_id});
  parts.kinematics = std::move(kinematics->object);
  parts.actuator_map = std::move(map->object);
  return {};
}

}  // namespace

Expected<std::shared_ptr<ServoLaw>> load_joint_law(const sdk::Joint& joint, const ModuleLoader& loader,
                                                   std::vector<ModuleInUse>& modules) {
  return load_law(joint.servo_law, joint.gains, "joint " + joint.limits.name, loader, modules);
}

Expected<std::shared_ptr<Mechanism>> assemble(const sdk::DeviceObject& device, const AssemblyOptions& options,
                                              const ModuleLoader& loader, BusRegistry& registry) {
  ServoLoopParts parts;
  parts.period_s = options.period_s;
  parts.virtual_mode = options.virtual_mode;
  parts.stop_categories = options.stop_categories;
  parts.max_cycles_lost = options.max_cycles_lost;
  std::vector<ModuleInUse> modules;
  auto ready = check_device(device)
                   .and_then([&] { return add_geometry(device, loader, parts, modules); })
                   .and_then([&] { return add_axes(device, loader, parts, modules); })
                   .and_then([&] { return add_drives(device, loader, registry, parts); })
                   .and_then([&] { return add_spindles(device, loader, registry, parts, modules); })
                   .and_then([&] { return add_sensors(device, loader, registry, parts); })
                   .and_then([&] { return add_io(device, loader, registry, parts); });
  if (!ready) return tl::unexpected(ready.error());

  PlannerModel model;
  model.kinematics = parts.kinematics;
  for (const sdk::Joint& joint : device.joints) model.joints.push_back(joint.limits);
  model.period_s = options.period_s;
  model.max_feed_mm_s = device.max_feedrate_mm_min / 60;
  auto loop = ServoLoop::create(std::move(parts));
  if (!loop) return tl::unexpected(loop.error());
  return std::make_shared<Mechanism>(device, std::move(model), std::shared_ptr<ServoLoop>(std::move(*loop)),
                                     std::move(modules));
}

}  // namespace rmac::gateway
