#include <fmt/format.h>

#include <cmath>

#include "gateway/buses/bus_choice.hpp"
#include "gateway/mechanism/loop_draft.hpp"

namespace rmac::gateway {
namespace {

/// The bus of a drive or sensor, brought up.
Expected<std::shared_ptr<ServoBus>> bus_of(const std::string& who, const std::string& name, std::uint32_t axis,
                                           const LoopDraft& draft) {
  if (draft.parts.virtual_mode) return draft.registry.virtual_bus(name);
  auto bus = draft.registry.acquire(name, interface_of_bus(name, draft.device.digital_control_interface), draft.loader);
  if (!bus) return bus;
  if (const std::size_t there = (*bus)->interface->axis_count(); axis >= there) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: bus {} has no axis {}; it has {}", who, name, axis, there));
  }
  return bus;
}

/// What is said of an actuator against what its drive says of itself.
Expected<> check_drive(const std::string& who, const sdk::Actuator& actuator,
                       const DigitalControlInterface& interface) {
  constexpr double kSameScale = 1e-6;
  const double told = interface.counts_per_revolution(actuator.axis);
  if (const double meant = actuator.scale.counts_per_revolution; told > 0 && std::abs(meant / told - 1) > kSameScale) {
    return failure(MinorCode::Scale,
                   fmt::format("{}: its drive (bus {}, axis {}) counts {:.10g} in a turn of the motor, and "
                               "CountsPerRevolution is {:.10g}; set one of them right",
                               who, actuator.bus, actuator.axis, told, meant));
  }
  if (actuator.probe_edge && !interface.latches(actuator.axis, *actuator.probe_edge)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: a touch probe of its drive is to latch its position, and bus {} does "
                               "not carry that for axis {}; leave TouchProbe out, or have its words carried",
                               who, actuator.bus, actuator.axis));
  }
  return {};
}

/// A spindle with real drives: its loop, as far as it is closed here.
Expected<> set_up(ServoSpindle& part, const std::string& who, const sdk::Spindle& spindle) {
  const DigitalControlInterface& interface = *part.bus->interface;
  const std::string drive = fmt::format("{} (bus {}, axis {})", who, spindle.bus, spindle.axis);
  if (spindle.scale.rated_torque_nm > 0 && !interface.tells_torque(spindle.axis)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: RatedTorque is given, and its drive tells no torque here; leave it out, or have "
                               "6077h carried",
                               drive));
  }
  part.mode = interface.mode(spindle.axis);
  part.method = spindle.method;
  part.scale = spindle.scale;
  part.max_acceleration_rpm_s = spindle.max_acceleration_rpm_s;
  part.max_following_error_deg = spindle.max_following_error_deg;
  part.max_torque_nm = spindle.max_torque_nm;
  part.speed_tolerance_rpm = spindle.speed_tolerance_rpm;
  part.speed_timeout_s = spindle.speed_timeout_s;
  return check_spindle(part, drive);
}

}  // namespace

Expected<> add_drives(LoopDraft& draft) {
  ServoLoopParts& parts = draft.parts;
  for (const sdk::Actuator& actuator : draft.device.actuators) {
    const std::string who = fmt::format("actuator {}", parts.actuators.size());
    auto bus = bus_of(who, actuator.bus, actuator.axis, draft);
    if (!bus) return tl::unexpected(bus.error());
    const DigitalControlInterface& interface = *(*bus)->interface;
    if (!parts.virtual_mode) {
      if (auto fine = check_drive(who, actuator, interface); !fine) return fine;
    }
    constexpr double kTorqueShare = 3.5;
    const double max_torque = actuator.max_measured_torque_nm > 0 ? actuator.max_measured_torque_nm
                                                                  : kTorqueShare * actuator.scale.rated_torque_nm;
    const DriveMode mode = parts.virtual_mode ? DriveMode::CyclicSyncTorque : interface.mode(actuator.axis);
    const double gain = parts.virtual_mode ? 0 : actuator.position_gain;
    parts.actuators.push_back({std::move(*bus), actuator.axis, actuator.scale,
                               static_cast<std::uint8_t>(actuator.homing_turn), max_torque, mode, gain,
                               actuator.probe_edge, actuator.cogging});
  }
  return {};
}

Expected<> add_spindles(LoopDraft& draft) {
  for (const sdk::Spindle& spindle : draft.device.spindles) {
    const std::string who = fmt::format("spindle {}", draft.parts.spindles.size());
    auto bus = bus_of(who, spindle.bus, spindle.axis, draft);
    if (!bus) return tl::unexpected(bus.error());
    std::shared_ptr<ServoLaw> law;
    if (!spindle.servo_law.name.empty()) {
      auto loaded = load_law(spindle.servo_law, spindle.gains, who, draft.loader, draft.modules);
      if (!loaded) return tl::unexpected(loaded.error());
      law = std::move(*loaded);
    }
    ServoSpindle part{.bus = std::move(*bus), .axis = spindle.axis, .max_speed_rpm = spindle.max_speed_rpm};
    if (!draft.parts.virtual_mode) {
      part.law = std::move(law);
      if (auto fine = set_up(part, who, spindle); !fine) return fine;
    }
    draft.parts.spindles.push_back(std::move(part));
  }
  return {};
}

Expected<> add_sensors(LoopDraft& draft) {
  if (draft.parts.virtual_mode) return {};
  for (std::size_t j = 0; j < draft.parts.joints.size(); ++j) {
    const sdk::Joint& joint = joint_at(draft.device, j);
    if (!joint.force_sensor) continue;
    const sdk::ForceSensor& sensor = *joint.force_sensor;
    auto bus = bus_of(fmt::format("force sensor of joint \"{}\"", joint.limits.name), sensor.bus, sensor.axis, draft);
    if (!bus) return tl::unexpected(bus.error());
    draft.parts.joints[j].force_sensor =
        ServoForceSensor{std::move(*bus), sensor.axis, sensor.newton_per_count, sensor.zero_counts};
  }
  return {};
}

}  // namespace rmac::gateway
