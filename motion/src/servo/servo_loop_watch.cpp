#include <bit>
#include <cmath>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

/// One word that came late makes one step of a position too short and the next one too long; three do not.
constexpr std::uint8_t kCyclesBeyond = 3;

bool faulted(const DriveFeedback& words) noexcept {
  const DriveState state = drive_state(words.statusword);
  return state == DriveState::Fault || state == DriveState::FaultReactionActive;
}

/// CiA 402's error codes 73xxh: the drive's own encoder or resolver.
bool reports_sensor(std::uint16_t error_code) noexcept {
  return (error_code & 0xFF00U) == 0x7300U;
}

bool beyond(double value, double bound, std::uint8_t& cycles) noexcept {
  cycles = bound > 0 && std::abs(value) > bound ? static_cast<std::uint8_t>(cycles + 1) : std::uint8_t{0};
  return cycles >= kCyclesBeyond;
}

std::uint32_t first(std::uint64_t bits) noexcept {
  return static_cast<std::uint32_t>(std::countr_zero(bits));
}

}  // namespace

void ServoLoop::Impl::watch_drive(const DriveFeedback& words, bool in_use, ServoFault::Part part,
                                  std::size_t index) noexcept {
  const auto number = static_cast<std::uint32_t>(index);
  if (in_use && !words.online) {
    raise({ServoFault::Kind::DriveOffline, part, number, 0, 0});
  } else if (words.online && faulted(words)) {
    raise({reports_sensor(words.error_code) ? ServoFault::Kind::SensorLost : ServoFault::Kind::DriveFault, part, number,
           static_cast<double>(words.error_code), 0});
  } else if (in_use && drive_state(words.statusword) != DriveState::OperationEnabled) {
    raise({ServoFault::Kind::DriveDropped, part, number, static_cast<double>(words.statusword), 0});
  }
}

void ServoLoop::Impl::watch_drives() noexcept {
  if (!powered()) return;
  std::uint32_t in_use = state == ServoState::Homing ? homing : 0;
  for (std::size_t j = 0; j < axes; ++j) {
    if (live[j]) in_use |= actuators_of[j];
  }
  for (std::size_t i = 0; i < actuators; ++i) {
    watch_drive(feedback(i), (in_use >> i & 1U) != 0, ServoFault::Part::Actuator, i);
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    const bool spindle_in_use = state == ServoState::Engaged || (braking && !given_up(ServoFault::Part::Spindle, i));
    watch_drive(spindle_feedback(i), spindle_in_use, ServoFault::Part::Spindle, i);
  }
}

void ServoLoop::Impl::watch_enabling() noexcept {
  if (state != ServoState::Enabling) return;
  if (static_cast<double>(++waiting_cycles) * parts.period_s <= parts.enable_timeout_s) return;
  const auto late = [this](const DriveFeedback& words, ServoFault::Part part, std::size_t index) {
    if (words.online && drive_state(words.statusword) == DriveState::OperationEnabled) return;
    const auto kind = words.online ? ServoFault::Kind::EnableTimeout : ServoFault::Kind::DriveOffline;
    raise(
        {kind, part, static_cast<std::uint32_t>(index), static_cast<double>(words.statusword), parts.enable_timeout_s});
  };
  for (std::size_t i = 0; i < actuators; ++i) late(feedback(i), ServoFault::Part::Actuator, i);
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) late(spindle_feedback(i), ServoFault::Part::Spindle, i);
}

void ServoLoop::Impl::watch_inputs(std::uint64_t now) noexcept {
  const std::uint64_t pressed = now & parts.emergency_stop_inputs;
  std::uint64_t reached = now & ~inputs & parts.limit_inputs;
  inputs = now;
  // A drive that looks for home may look for it in its limit switch.
  for (const ServoLimit& limit : parts.limits) {
    const bool homes = state == ServoState::Homing && (actuators_of[limit.joint] & homing) != 0;
    if (homes) reached &= ~limit.input;
  }
  if (pressed != 0) raise({ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, first(pressed), 0, 0});
  if (reached != 0) raise({ServoFault::Kind::LimitSwitch, ServoFault::Part::Io, first(reached), 0, 0});
}

// Whoever was told of a switch and reset the machine may move off it, and no further.
void ServoLoop::Impl::watch_limits() noexcept {
  constexpr double kStanding = 1e-6;  // mm/s or deg/s; less is rounding
  if (state != ServoState::Engaged) return;
  for (const ServoLimit& limit : parts.limits) {
    const bool on = (inputs & limit.input) != 0;
    if (!on || !live[limit.joint] || set_velocity[limit.joint] * limit.direction <= kStanding) continue;
    raise({ServoFault::Kind::LimitSwitch, ServoFault::Part::Io, first(limit.input), 0, 0});
    return;
  }
}

void ServoLoop::Impl::watch_cycles(std::uint64_t missed) noexcept {
  if (parts.max_cycles_lost <= 0) return;
  if (static_cast<double>(++second_cycles) * parts.period_s > 1) missed_cycles = 0, second_cycles = 0;
  missed_cycles += missed;
  if (!driving() || missed_cycles <= static_cast<std::uint64_t>(parts.max_cycles_lost)) return;
  raise({ServoFault::Kind::CyclesLost, ServoFault::Part::Clock, 0, static_cast<double>(missed_cycles),
         static_cast<double>(parts.max_cycles_lost)});
}

void ServoLoop::Impl::watch_joints() noexcept {
  for (std::size_t j = 0; j < axes; ++j) {
    if (!powered() || !live[j]) {
      too_fast[j] = 0;
      continue;
    }
    watch_jump(j);
    watch_sensor(j);
    const double error = following_error(j);
    const double bound = parts.axes[j].max_following_error;
    if (!(std::abs(error) <= bound)) {
      raise({ServoFault::Kind::FollowingError, ServoFault::Part::Joint, static_cast<std::uint32_t>(j), error, bound});
    }
    watch_velocity(j);
    if (parts.axes[j].method == ControlMethod::Force) watch_contact(j);
  }
}

void ServoLoop::Impl::watch_jump(std::size_t joint) noexcept {
  const double bound = parts.axes[joint].bounds.jump;
  if (!(bound > 0) || std::abs(jumped[joint]) <= bound) return;
  raise({ServoFault::Kind::EncoderJump, ServoFault::Part::Joint, static_cast<std::uint32_t>(joint), jumped[joint],
         bound});
}

void ServoLoop::Impl::watch_velocity(std::size_t joint) noexcept {
  const double bound = parts.axes[joint].bounds.velocity;
  if (!beyond(velocity[joint], bound, too_fast[joint])) return;
  raise({ServoFault::Kind::VelocityBound, ServoFault::Part::Joint, static_cast<std::uint32_t>(joint), velocity[joint],
         bound});
}

// A stop that keeps power may have begun without the sensor, or beyond the force's bound: that does not end it.
void ServoLoop::Impl::watch_sensor(std::size_t joint) noexcept {
  const auto& sensor = parts.axes[joint].force_sensor;
  if (!sensor || braking) return;
  const DriveFeedback& words = sensor->bus->feedback[sensor->axis];
  if (words.online && words.sensor_valid) return;
  raise({ServoFault::Kind::SensorLost, ServoFault::Part::Joint, static_cast<std::uint32_t>(joint), 0, 0});
}

void ServoLoop::Impl::watch_contact(std::size_t joint) noexcept {
  if (braking) return;
  const ForceControl& control = parts.axes[joint].force;
  const auto number = static_cast<std::uint32_t>(joint);
  if (!(std::abs(force[joint]) <= control.max_force)) {
    raise({ServoFault::Kind::ForceLimit, ServoFault::Part::Joint, number, force[joint], control.max_force});
  }
  const bool at_end = (hold[joint] > parts.axes[joint].bounds.max_position && set_velocity[joint] > 0) ||
                      (hold[joint] < parts.axes[joint].bounds.min_position && set_velocity[joint] < 0);
  const double searched = force_loops[joint].searched();
  const bool searching = force_loops[joint].state() == ContactState::Approaching;
  if (at_end || (searching && searched > control.max_search)) {
    raise({ServoFault::Kind::ContactLost, ServoFault::Part::Joint, number, searched, control.max_search});
  }
}

void ServoLoop::Impl::watch_torques() noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    const ServoActuator& actuator = parts.actuators[i];
    const double measured_nm = feedback(i).torque_permille * actuator.scale.rated_torque_nm / 1000;
    const bool too_much = beyond(powered() ? measured_nm : 0, actuator.max_torque_nm, too_strong[i]);
    if (!too_much) continue;
    raise({ServoFault::Kind::TorqueBound, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), measured_nm,
           actuator.max_torque_nm});
  }
}

}  // namespace rmac
