#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

void ServoLoop::cycle(const ServoCommand& command, ServoReport& report) noexcept {
  Impl& loop = *impl_;
  loop.follows = false;
  loop.exchange(command, report);
  loop.change_state(command);
  if (loop.parts.virtual_mode) {
    loop.finish_reset();
    loop.make_setpoints(command, report);
    loop.reflect_setpoints();
  } else {
    loop.read_actuators();
    loop.read_joints();
    loop.read_spindles();
    loop.watch_drives();
    loop.watch_cycles(command.cycles_missed);
    loop.finish_reset();
    loop.run_homing(command);
    loop.make_live();
    loop.make_setpoints(command, report);
    loop.watch_limits();
    loop.watch_joints();
    loop.watch_torques();
    loop.watch_spindles(command);
    report.follows = loop.follows;
    loop.run_laws();
    loop.run_spindles(command);
    loop.watch_enabling();
    loop.remove_power_at_rest();
    loop.make_torques();
    loop.aim_shafts();
    loop.write_actuators();
    loop.write_spindles();
  }
  loop.fill(command, report);
}

void ServoLoop::Impl::exchange(const ServoCommand& command, ServoReport& report) noexcept {
  if (parts.virtual_mode) {
    report.inputs = 0;
    report.exchange_ns = 0;
    return;
  }
  const auto begun = std::chrono::steady_clock::now();
  if (fresh) {
    for (const auto& bus : buses) std::fill(bus->commands.begin(), bus->commands.end(), DriveCommand{});
    fresh = false;
  }
  for (std::size_t b = 0; b < buses.size(); ++b) {
    if (!buses[b]->interface->exchange(buses[b]->commands, buses[b]->feedback)) {
      raise({ServoFault::Kind::BusFailure, ServoFault::Part::Bus, static_cast<std::uint32_t>(b), 0, 0});
    }
  }
  if (parts.io && !parts.io->exchange(command.outputs, report.inputs)) {
    raise({ServoFault::Kind::IoFailure, ServoFault::Part::Io, 0, 0, 0});
  }
  report.exchange_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now() - begun).count();
  if (!parts.io) report.inputs = 0;
  read_drive_inputs(report.inputs);
  watch_inputs(report.inputs);
  read_probe();
}

const DriveFeedback& ServoLoop::Impl::feedback(std::size_t actuator) const noexcept {
  const ServoActuator& part = parts.actuators[actuator];
  return part.bus->feedback[part.axis];
}

double ServoLoop::Impl::shaft_rad(std::size_t actuator, double at_counts) const noexcept {
  const DriveScale& scale = parts.actuators[actuator].scale;
  return scale.direction * (at_counts - scale.home_counts) * (2 * std::numbers::pi / scale.counts_per_revolution);
}

double ServoLoop::Impl::shaft_counts(std::size_t actuator, double rad) const noexcept {
  const DriveScale& scale = parts.actuators[actuator].scale;
  return scale.home_counts + scale.direction * rad * (scale.counts_per_revolution / (2 * std::numbers::pi));
}

void ServoLoop::Impl::read_actuators() noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    const DriveFeedback& words = feedback(i);
    if (!words.online) {
      history[i] = 0;
      shaft_velocity[i] = 0;
      continue;
    }
    // The drive's word wraps at 32 bits: the difference to the last reading, taken modulo 2^32, does not.
    const std::int64_t last = seen[i] ? counts[i] : std::int64_t{parts.actuators[i].scale.home_counts};
    const auto moved =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(words.position_counts) - static_cast<std::uint32_t>(last));
    counts[i] = last + moved;
    const double now = shaft_rad(i, static_cast<double>(counts[i]));
    const double back1 = now - shaft[i];
    const double back2 = shaft[i] - shaft_before[i];
    const double moved_rad = history[i] == 0 ? 0 : history[i] == 1 ? back1 : (3 * back1 - back2) / 2;
    shaft_velocity[i] = moved_rad / parts.period_s;
    history[i] = static_cast<std::uint8_t>(std::min(history[i] + 1, 2));
    shaft_before[i] = shaft[i];
    shaft[i] = now;
    seen[i] = true;
  }
}

void ServoLoop::Impl::read_joints() noexcept {
  parts.actuator_map->joint_positions({shaft.data(), actuators}, {position.data(), axes});
  parts.actuator_map->joint_velocities({shaft.data(), actuators}, {shaft_velocity.data(), actuators},
                                       {velocity.data(), axes});
  for (std::size_t j = 0; j < axes; ++j) {
    const double shown = position[j];
    jumped[j] = shown_history[j] == 2 ? shown - 2 * shown1[j] + shown2[j] : 0;
    shown2[j] = shown1[j];
    shown1[j] = shown;
    // A drive that homes moves its counter by more than its shaft.
    shown_history[j] =
        live[j] && answering(j) ? static_cast<std::uint8_t>(std::min(shown_history[j] + 1, 2)) : std::uint8_t{0};
    if (const auto& sensor = parts.axes[j].force_sensor) {
      const DriveFeedback& words = sensor->bus->feedback[sensor->axis];
      force[j] = (static_cast<double>(words.sensor_counts) - sensor->zero_counts) * sensor->newton_per_count;
    }
    PositionCorrection& correction = corrections[j];
    correction.follow(live[j] ? set_velocity[j] : 0, parts.period_s);
    velocity[j] = correction.actual_velocity(position[j], velocity[j]);
    position[j] = correction.actual(position[j]);
  }
}

ServoInput ServoLoop::Impl::input(std::size_t joint) const noexcept {
  return {.position_setpoint = hold[joint],
          .velocity_setpoint = set_velocity[joint] + corrections[joint].crossing_velocity(),
          .acceleration_setpoint = set_acceleration[joint] + corrections[joint].crossing_acceleration(),
          .position = position[joint] + gone_on[joint],
          .velocity = velocity[joint] + velocity_gone_on[joint] + corrections[joint].crossing_velocity(),
          .effort = effort[joint],
          .period_s = parts.period_s};
}

bool ServoLoop::Impl::answering(std::size_t joint) const noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    if ((actuators_of[joint] >> i & 1U) != 0 && !feedback(i).online) return false;
  }
  return true;
}

bool ServoLoop::Impl::operable(std::size_t joint) const noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    if ((actuators_of[joint] >> i & 1U) == 0) continue;
    const DriveFeedback& words = feedback(i);
    if (!words.online || drive_state(words.statusword) != DriveState::OperationEnabled) return false;
    if (words.mode != DriveMode::None && words.mode != parts.actuators[i].mode) return false;
  }
  return true;
}

void ServoLoop::Impl::make_live() noexcept {
  if (!driving() || state == ServoState::Homing) return;
  bool all = true;
  gone_on.fill(0);
  velocity_gone_on.fill(0);
  for (std::size_t j = 0; j < axes; ++j) {
    if (!live[j] && operable(j)) {
      live[j] = true;
      hold[j] = position[j];
      set_velocity[j] = set_acceleration[j] = 0;
      engage_law(j, resting_effort(j));
    } else if (handed[j]) {
      engage_law(j, effort[j]);
    }
    handed[j] = false;
    all = all && live[j];
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    const DriveFeedback& words = spindle_feedback(i);
    all = all && words.online && drive_state(words.statusword) == DriveState::OperationEnabled;
  }
  // A cycle passes between engaging and following, in which the follower is put at where the joints hold.
  if (state == ServoState::Enabling && all) {
    state = ServoState::Engaged;
  } else {
    follows = state == ServoState::Engaged;
  }
}

double ServoLoop::Impl::resting_effort(std::size_t joint) const noexcept {
  if (!parts.axes[joint].law) return 0;
  const double wanted = parts.axes[joint].law->resting_effort();
  const double bound = parts.axes[joint].max_effort;
  return std::isfinite(wanted) ? std::clamp(wanted, -bound, bound) : 0;
}

void ServoLoop::Impl::engage_law(std::size_t joint, double from_effort) noexcept {
  if (!parts.axes[joint].law) return;
  parts.axes[joint].law->engage(input(joint), from_effort);
  filters[joint].engage(from_effort);
}

void ServoLoop::Impl::run_laws() noexcept {
  for (std::size_t j = 0; j < axes; ++j) {
    effort[j] = 0;
    if (!powered() || !parts.axes[j].law) continue;
    if (!live[j]) {
      // A drive acts on the torque beside the word that enables it, before any position of it could be controlled.
      effort[j] = braking ? 0 : resting_effort(j);
      continue;
    }
    const ServoAxis& axis = parts.axes[j];
    const double wanted = axis.law->update(input(j));
    if (!std::isfinite(wanted)) {
      raise({ServoFault::Kind::NotANumber, ServoFault::Part::Joint, static_cast<std::uint32_t>(j), wanted, 0});
      return;
    }
    effort[j] = std::clamp(filters[j].update(wanted), -axis.max_effort, axis.max_effort);
  }
}

void ServoLoop::Impl::make_torques() noexcept {
  torque.fill(0);
  if (!powered()) return;
  parts.actuator_map->actuator_efforts({position.data(), axes}, {effort.data(), axes}, {torque.data(), actuators});
  for (std::size_t i = 0; i < actuators; ++i) {
    if (std::isfinite(torque[i])) continue;
    raise({ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), torque[i], 0});
    torque.fill(0);
    return;
  }
}

bool ServoLoop::Impl::controlled(std::size_t actuator) const noexcept {
  for (std::size_t j = 0; j < axes; ++j) {
    if ((actuators_of[j] >> actuator & 1U) != 0 && !live[j]) return false;
  }
  return powered();
}

void ServoLoop::Impl::aim_shafts() noexcept {
  const std::array<double, kMaxJoints> before = aim;
  if (const auto all = (std::uint64_t{1} << actuators) - 1; torque_drives != all) {
    shafts_for({hold.data(), axes}, {aim.data(), actuators});
  }
  for (std::size_t i = 0; i < actuators; ++i) {
    const bool follows_aim = (torque_drives >> i & 1U) == 0 && controlled(i);
    if (follows_aim && !std::isfinite(aim[i])) {
      raise({ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), aim[i], 0});
      aimed.fill(false);
      return;
    }
    aim_before[i] = aimed[i] ? before[i] : aim[i];
    aimed[i] = follows_aim;
  }
}

void ServoLoop::Impl::write_actuators() noexcept {
  for (std::size_t i = 0; i < actuators; ++i) {
    const ServoActuator& part = parts.actuators[i];
    DriveCommand& words = part.bus->commands[part.axis];
    const DriveFeedback& from = feedback(i);
    words.controlword =
        next_controlword(from.statusword, wish(ServoFault::Part::Actuator, i), resetting, words.controlword);
    words.mode = part.mode;
    command_homing(i, words);
    words.target_position_counts = from.position_counts;
    words.target_velocity_rpm = 0;
    if (aimed[i]) command_aim(i, words);
    words.touch_probe = latches[i] ? latches[i]->function() : std::uint16_t{0};
    const double permille = part.scale.direction * torque[i] * 1000 / part.scale.rated_torque_nm;
    words.target_torque_permille = static_cast<std::int16_t>(std::lround(std::clamp(permille, -32767.0, 32767.0)));
  }
}

void ServoLoop::Impl::command_aim(std::size_t actuator, DriveCommand& words) const noexcept {
  const ServoActuator& part = parts.actuators[actuator];
  if (part.mode == DriveMode::CyclicSyncPosition) {
    // The drive's word wraps at 32 bits, as its answer does.
    const auto wide = static_cast<std::uint64_t>(std::llround(shaft_counts(actuator, aim[actuator])));
    words.target_position_counts = static_cast<std::int32_t>(static_cast<std::uint32_t>(wide));
  } else {
    const double when_it_told = (late_drives >> actuator & 1U) != 0 ? aim_before[actuator] : aim[actuator];
    const double wanted =
        (aim[actuator] - aim_before[actuator]) / parts.period_s + part.position_gain * (when_it_told - shaft[actuator]);
    words.target_velocity_rpm = part.scale.direction * wanted * 30 / std::numbers::pi;
  }
}

}  // namespace rmac
