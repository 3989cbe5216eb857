#include "gateway/events/fault_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "gateway/mechanism/joint_name.hpp"
#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/fieldbus/fault_texts.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::gateway {
namespace {

const ServoBus* bus_at(std::uint32_t index, const Mechanism* mechanism) {
  return mechanism == nullptr ? nullptr : mechanism->loop->bus(index);
}

/// As the actuator, spindle or force sensor that is on it names it.
std::string bus_name(std::uint32_t index, const Mechanism* mechanism) {
  const ServoBus* const bus = bus_at(index, mechanism);
  if (bus == nullptr) return fmt::format("bus {}", index);
  const ServoLoopParts& parts = mechanism->loop->parts();
  const sdk::DeviceObject& device = mechanism->device;
  for (std::size_t i = 0; i < parts.actuators.size(); ++i) {
    if (parts.actuators[i].bus.get() == bus) return "bus " + device.actuators.at(i).bus;
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    if (parts.spindles[i].bus.get() == bus) return "bus " + device.spindles.at(i).bus;
  }
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const auto& sensor = parts.joints[j].force_sensor;
    if (sensor && sensor->bus.get() == bus) return "bus " + joint_at(device, j).force_sensor->bus;
  }
  return fmt::format("bus {}", index);
}

std::string where(const ServoFault& fault, const Mechanism* mechanism) {
  const sdk::DeviceObject* device = mechanism != nullptr ? &mechanism->device : nullptr;
  switch (fault.part) {
    case ServoFault::Part::Joint:
      return joint_name(fault.index, device);
    case ServoFault::Part::Actuator:
      if (device != nullptr && fault.index < device->actuators.size()) {
        const sdk::Actuator& actuator = device->actuators[fault.index];
        return fmt::format("drive of actuator {} (bus {}, axis {})", fault.index, actuator.bus, actuator.axis);
      }
      return fmt::format("drive of actuator {}", fault.index);
    case ServoFault::Part::Spindle:
      if (device != nullptr && fault.index < device->spindles.size()) {
        const sdk::Spindle& spindle = device->spindles[fault.index];
        return fmt::format("drive of spindle {} (bus {}, axis {})", fault.index, spindle.bus, spindle.axis);
      }
      return fmt::format("drive of spindle {}", fault.index);
    case ServoFault::Part::Bus:
      return bus_name(fault.index, mechanism);
    case ServoFault::Part::Io:
      return "digital I/O";
    case ServoFault::Part::Clock:
      return "servo thread";
  }
  return "somewhere";
}

std::string input_name(std::uint32_t bit, const Mechanism* mechanism) {
  if (mechanism != nullptr) {
    for (const auto& [name, at] : mechanism->device.inputs) {
      if (static_cast<std::uint32_t>(at) == bit) return fmt::format("{} (input {})", name, bit);
    }
  }
  return fmt::format("input {}", bit);
}

/// A limit switch of a known joint and end, towards which that joint moves no further.
bool holds_back(std::uint32_t bit, const Mechanism* mechanism) {
  if (mechanism == nullptr) return false;
  const auto& limits = mechanism->loop->parts().limits;
  return std::any_of(limits.begin(), limits.end(),
                     [bit](const ServoLimit& limit) { return limit.input == std::uint64_t{1} << bit; });
}

/// Why the exchange with an interface failed.
template <typename Interface>
std::string exchange_text(const Interface* interface, const char* otherwise) {
  const auto* told = dynamic_cast<const fieldbus::ExchangeFaultText*>(interface);
  return told != nullptr ? told->fault_text() : otherwise;
}

std::string io_text(const Mechanism* mechanism) {
  const DigitalIoInterface* io = mechanism == nullptr ? nullptr : mechanism->loop->parts().io.get();
  return exchange_text(io, "the device failed; check it");
}

std::string bus_text(std::uint32_t index, const Mechanism* mechanism) {
  const ServoBus* const bus = bus_at(index, mechanism);
  const DigitalControlInterface* interface = bus == nullptr ? nullptr : bus->interface.get();
  return exchange_text(interface, "the bus failed; check the interface");
}

/// The drive that a fault names: its bus, and its place there.
struct DriveOnBus {
  const DigitalControlInterface* interface = nullptr;
  std::uint32_t axis = 0;
};
DriveOnBus drive_of(const ServoFault& fault, const Mechanism* mechanism) {
  if (mechanism == nullptr) return {};
  const auto in = [&fault](const auto& drives) -> DriveOnBus {
    if (fault.index >= drives.size()) return {};
    return {drives[fault.index].bus->interface.get(), drives[fault.index].axis};
  };
  const ServoLoopParts& parts = mechanism->loop->parts();
  if (fault.part == ServoFault::Part::Spindle) return in(parts.spindles);
  return fault.part == ServoFault::Part::Actuator ? in(parts.actuators) : DriveOnBus{};
}

/// A drive's error code, as its interface tells it or else as CiA 402 does.
std::string code_text(const ServoFault& fault, std::uint16_t code, const Mechanism* mechanism) {
  const DriveOnBus drive = drive_of(fault, mechanism);
  const auto* texts = dynamic_cast<const fieldbus::FaultTexts*>(drive.interface);
  return texts != nullptr ? texts->fault_text(drive.axis, code) : fieldbus::canopen::emergency_text(code);
}

/// Why a drive is silent, as far as its interface knows.
std::string silence_text(const ServoFault& fault, const Mechanism* mechanism) {
  const DriveOnBus drive = drive_of(fault, mechanism);
  const auto* texts = dynamic_cast<const fieldbus::SilenceText*>(drive.interface);
  const auto text = texts != nullptr ? texts->silence_text(drive.axis) : std::nullopt;
  return text.value_or("the drive does not answer; check its power and its cable");
}

/// What only a spindle's own watch finds; nothing for what any drive may have.
std::optional<std::string> spindle_cause(const ServoFault& fault, const std::string& at, const Mechanism* mechanism) {
  switch (fault.kind) {
    case ServoFault::Kind::FollowingError:
      return fmt::format(
          "{}: its angle is {:.4g} degrees off, beyond the bound of {:.4g}; look for a blocked spindle or weak gains, "
          "then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::VelocityBound:
      return fmt::format(
          "{}: it turns at {:.4g} rpm, a fifth beyond its {:.4g} rpm; look for a drive that runs away, or a wrong "
          "scale or direction, then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::TorqueBound: {
      const bool own = mechanism == nullptr || fault.index >= mechanism->device.spindles.size() ||
                       fault.bound >= mechanism->device.spindles[fault.index].max_torque_nm;
      return fmt::format(
          "{}: it gave {:.3g} N·m for a tenth of a second, and {} {:.3g} N·m; look at the tool, which may be blunt or "
          "stuck, and cut less at once, then reset",
          at, fault.value, own ? "may give" : "its tool bears", fault.bound);
    }
    default:
      return {};
  }
}

/// What a joint's motion or measurement has beyond its bound.
std::string joint_cause(const ServoFault& fault, const std::string& at) {
  switch (fault.kind) {
    case ServoFault::Kind::FollowingError:
      return fmt::format(
          "{}: following error {:.4g} is beyond the bound of {:.4g}; look for a blocked axis, a wrong "
          "scale or weak gains, then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::VelocityBound:
      return fmt::format(
          "{}: it moves at {:.4g} per second, beyond the bound of {:.4g}; look for a drive that runs away, a wrong "
          "scale or a wrong direction, then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::TorqueBound:
      return fmt::format(
          "{}: it gives {:.3g} N·m, beyond the bound of {:.3g} N·m; look for a collision or a drive whose current loop "
          "is out of order, then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::Oscillation:
      return fmt::format(
          "{}: its servo loop swings at about {:.3g} Hz, its effort by {:.3g} either way; look for loose mechanics or "
          "for what holds the joint, load it with softer loops (`rmac load --soften 8`, or by more where it swings "
          "then, too), and have `rmac tune` find gains and filters for it",
          at, fault.value, fault.bound);
    case ServoFault::Kind::WrongDirection:
      return fmt::format(
          "{}: it went {:.3g} faster and faster against an effort of {:.3g}; look for a motor or an encoder whose "
          "direction is reversed (Direction, phases), or for what pushes it, then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::StandsStill:
      return fmt::format(
          "{}: its position stands still for {:.3g} s, and it was to go {:.3g}; look for what blocks the axis or what "
          "it met, whether its brake opens and its drive gives torque, at the coupling of its encoder, and for "
          "friction "
          "that its loop is too weak to overcome and does not know of (`rmac tune --creep`), then reset",
          at, fault.bound, fault.value);
    case ServoFault::Kind::EncoderFrozen:
      return fmt::format(
          "{}: its encoder tells the same to the last digit for {:.3g} s, while the effort changed by {:.3g}: it "
          "froze, or its shaft is held fast; check the encoder, its cable, its coupling and the brake, and look where "
          "the axis really is{}, then reset and find the reference again",
          at, fault.value, fault.bound,
          fault.part == ServoFault::Part::Actuator ? ", and square what it moves together with others" : "");
    case ServoFault::Kind::Skewed:
      return fmt::format(
          "{}: the motors of its joint stand {:.4g} apart, beyond the bound of {:.4g} (MaxSkew, or without it "
          "MaxFollowingError), and it lags or is farthest from its place; look for what blocks this side, and at its "
          "encoder, coupling and brake; where the frame is soft, give the joint a Gantry with Stiffness and Damping, "
          "then reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::EncoderJump:
      return fmt::format(
          "{}: its position jumped by {:.4g} within a cycle, and motion explains {:.4g}; check the encoder, its cable "
          "and its screen, then reset and find the reference again",
          at, fault.value, fault.bound);
    case ServoFault::Kind::Displaced:
      return fmt::format(
          "{}: it stands {:.4g} from where the machine was left, or from where its drive would be sent, and {:.4g} is "
          "allowed (MaxJump), so it is not enabled; look where it really is, and at its encoder, then reset and find "
          "the reference again",
          at, fault.value, fault.bound);
    case ServoFault::Kind::SensorLost:
      return fmt::format(
          "{}: its force sensor gives no valid value, or the same one however hard the joint is pushed; check the "
          "sensor, its amplifier and its cable, then reset",
          at);
    case ServoFault::Kind::ForceLimit:
      return fmt::format(
          "{}: it pushes with {:.4g}, beyond the bound of {:.4g}; look at what it met, back off, then "
          "reset",
          at, fault.value, fault.bound);
    case ServoFault::Kind::ContactLost:
      return fmt::format("{}: it went {:.4g} without contact, as far as it may; look where the part is, then reset", at,
                         fault.value);
    default:
      return at;
  }
}

/// What a drive says, or does not say, by itself.
std::string drive_cause(const ServoFault& fault, const std::string& at, const Mechanism* mechanism) {
  const auto word = static_cast<std::uint16_t>(std::lround(std::abs(fault.value)));
  switch (fault.kind) {
    case ServoFault::Kind::SensorLost:
      return fmt::format(
          "{}: the drive has lost its encoder (error {:04X}h, {}); check the encoder and its cable, "
          "then reset",
          at, word, code_text(fault, word, mechanism));
    case ServoFault::Kind::DriveFault:
      return fmt::format(
          "{}: the drive reports error {:04X}h ({}); look it up in its manual, remove the cause, then reset", at, word,
          code_text(fault, word, mechanism));
    case ServoFault::Kind::DriveOffline:
      return fmt::format("{}: {}, then reset", at, silence_text(fault, mechanism));
    case ServoFault::Kind::DriveDropped:
      return fmt::format(
          "{}: the drive left Operation Enabled by itself and is in {}; check its enable chain, then "
          "reset",
          at, drive_state_text(word));
    case ServoFault::Kind::EnableTimeout:
      return fmt::format(
          "{}: the drive was not enabled within {:.3g} s, it stays in {}; check its power and its enable "
          "chain, then reset",
          at, fault.bound, drive_state_text(word));
    case ServoFault::Kind::HomingFailed:
      return fault.bound > 0
                 ? fmt::format(
                       "{}: the drive found no home within {:.3g} s (statusword {:04X}h); check its switch and "
                       "its homing speeds, then reset",
                       at, fault.bound, word)
                 : fmt::format(
                       "{}: the drive gave up looking for home (statusword {:04X}h); check its switch and its "
                       "homing method, then reset",
                       at, word);
    default:
      return at;
  }
}

std::string cause(const ServoFault& fault, const Mechanism* mechanism) {
  std::string at = where(fault, mechanism);
  if (fault.part == ServoFault::Part::Spindle) {
    if (auto text = spindle_cause(fault, at, mechanism)) return *text;
  }
  using Kind = ServoFault::Kind;
  switch (fault.kind) {
    case Kind::None:
      return "no fault";
    case Kind::SensorLost:
      return fault.part == ServoFault::Part::Joint ? joint_cause(fault, at) : drive_cause(fault, at, mechanism);
    case Kind::FollowingError:
    case Kind::VelocityBound:
    case Kind::TorqueBound:
    case Kind::Oscillation:
    case Kind::WrongDirection:
    case Kind::StandsStill:
    case Kind::EncoderFrozen:
    case Kind::Skewed:
    case Kind::EncoderJump:
    case Kind::Displaced:
    case Kind::ForceLimit:
    case Kind::ContactLost:
      return joint_cause(fault, at);
    case Kind::DriveFault:
    case Kind::DriveOffline:
    case Kind::DriveDropped:
    case Kind::EnableTimeout:
    case Kind::HomingFailed:
      return drive_cause(fault, at, mechanism);
    case Kind::CyclesLost:
      return fmt::format(
          "{}: {:.0f} deadlines were missed within a second, and {:.0f} are allowed; look at the load of the "
          "controller and at docs/real-time.md, then reset",
          at, fault.value, fault.bound);
    case Kind::NotANumber:
      return fmt::format("{}: the servo loop computed no number; check gains and feedback, then reset", at);
    case Kind::BusFailure:
      return fmt::format("{}: {}, then reset", at, bus_text(fault.index, mechanism));
    case Kind::IoFailure:
      return fmt::format("{}: {}, then reset", at, io_text(mechanism));
    case Kind::EmergencyStop:
      return fmt::format("{} stopped the machine; release it, then reset", input_name(fault.index, mechanism));
    case Kind::LimitSwitch:
      return fmt::format("{} is reached; reset, then jog the axis off it{}", input_name(fault.index, mechanism),
                         holds_back(fault.index, mechanism) ? "" : ": nothing keeps it from moving on towards it");
  }
  return at;
}

}  // namespace

std::string describe(const ServoFault& fault, const Mechanism* mechanism) {
  if (fault.kind == ServoFault::Kind::None) return "no fault";
  if (fault.stop == StopCategory::StopThenRemovePower) {
    return cause(fault, mechanism) + ". Stop category 1: the drives brake, and lose their power at rest";
  }
  const bool but_one = fault.kind == ServoFault::Kind::DriveOffline && fault.part == ServoFault::Part::Actuator;
  return cause(fault, mechanism) + ". Stop category 2: every " + (but_one ? "other " : "") +
         "joint brakes and is held under power";
}

MinorCode code_of(ServoFault::Kind kind) noexcept {
  using Kind = ServoFault::Kind;
  switch (kind) {
    case Kind::None:
      return MinorCode::None;
    case Kind::EmergencyStop:
      return MinorCode::EmergencyStop;
    case Kind::LimitSwitch:
      return MinorCode::TravelLimit;
    case Kind::VelocityBound:
      return MinorCode::SpeedLimit;
    case Kind::EncoderFrozen:
    case Kind::EncoderJump:
    case Kind::Displaced:
    case Kind::SensorLost:
      return MinorCode::Scale;
    case Kind::DriveOffline:
    case Kind::BusFailure:
    case Kind::IoFailure:
      return MinorCode::CommTimeout;
    case Kind::EnableTimeout:
    case Kind::HomingFailed:
      return MinorCode::ResponseTimeout;
    case Kind::DriveDropped:  // and does not say why
      return MinorCode::Unknown;
    case Kind::FollowingError:
    case Kind::TorqueBound:
    case Kind::Oscillation:
    case Kind::WrongDirection:
    case Kind::StandsStill:
    case Kind::Skewed:
    case Kind::ForceLimit:
    case Kind::ContactLost:
    case Kind::CyclesLost:
    case Kind::NotANumber:
    case Kind::DriveFault:
      break;
  }
  return MinorCode::Other;
}

Event event_of(const FaultRecord& record, const Mechanism* mechanism) {
  return {Event::Kind::Fault,        record.t_s, record.move_id, describe(record.fault, mechanism), record.cycle, {},
          code_of(record.fault.kind)};
}

}  // namespace rmac::gateway
