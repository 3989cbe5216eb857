#include <bit>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

bool faulted(const DriveFeedback& words) noexcept {
  const DriveState state = drive_state(words.statusword);
  return state == DriveState::Fault || state == DriveState::FaultReactionActive;
}

}  // namespace

DriveWish ServoLoop::Impl::wish() const noexcept {
  if (driving()) return DriveWish::Operational;
  return state == ServoState::Off ? DriveWish::Off : DriveWish::QuickStop;
}

void ServoLoop::Impl::let_go() noexcept {
  live.fill(false);
  handed.fill(false);
  effort.fill(0);
}

void ServoLoop::Impl::raise(const ServoFault& found) noexcept {
  const bool graver = found.kind == ServoFault::Kind::EmergencyStop && fault.kind != found.kind;
  if (state == ServoState::Faulted && !graver) return;
  fault = found;
  state = ServoState::Faulted;
  power_spent = true;
  follows = false;
  let_go();
}

void ServoLoop::Impl::watch_inputs(std::uint64_t now) noexcept {
  const std::uint64_t pressed = now & parts.emergency_stop_inputs;
  const std::uint64_t reached = now & ~inputs & parts.limit_inputs;
  inputs = now;
  const auto first = [](std::uint64_t bits) { return static_cast<std::uint32_t>(std::countr_zero(bits)); };
  if (pressed != 0) raise({ServoFault::Kind::EmergencyStop, ServoFault::Part::Io, first(pressed), 0, 0});
  if (reached != 0) raise({ServoFault::Kind::LimitSwitch, ServoFault::Part::Io, first(reached), 0, 0});
}

void ServoLoop::Impl::change_state(const ServoCommand& command) noexcept {
  if (command.reset && !reset_before) {
    resetting = true;
    waiting_cycles = 0;
  }
  reset_before = command.reset;
  if (!command.power) power_spent = false;

  switch (state) {
    case ServoState::Off:
      if (command.power && !power_spent && !command.quick_stop && !resetting) {
        state = ServoState::Enabling;
        waiting_cycles = 0;
      }
      break;
    case ServoState::Enabling:
    case ServoState::Engaged:
    case ServoState::Homing:
      if (command.quick_stop) {
        state = ServoState::QuickStop;
        power_spent = true;
        let_go();
      } else if (!command.power) {
        state = ServoState::Off;
        let_go();
      } else if (state == ServoState::Engaged && command.home && !home_before && !parts.virtual_mode) {
        begin_homing();
      } else if (parts.virtual_mode && waiting_cycles++ > 0) {
        state = ServoState::Engaged;
      }
      break;
    case ServoState::QuickStop:
      if (!command.quick_stop && !command.power) state = ServoState::Off;
      break;
    case ServoState::Faulted:
      break;
  }
  home_before = command.home;
}

void ServoLoop::Impl::finish_reset() noexcept {
  if (!resetting) return;
  bool any = (inputs & parts.emergency_stop_inputs) != 0;
  if (!parts.virtual_mode) {
    for (std::size_t i = 0; i < actuators; ++i) any = any || faulted(feedback(i));
    for (std::size_t i = 0; i < parts.spindles.size(); ++i) any = any || faulted(spindle_feedback(i));
  }
  if (!any) {
    resetting = false;
    if (state == ServoState::Faulted) {
      state = ServoState::Off;
      fault = {};
    }
  } else if (static_cast<double>(++waiting_cycles) * parts.period_s > parts.enable_timeout_s) {
    resetting = false;  // the drives keep their faults: their cause is still there
  }
}

void ServoLoop::Impl::watch_drive(const DriveFeedback& words, bool in_use, ServoFault::Part part,
                                  std::size_t index) noexcept {
  const auto number = static_cast<std::uint32_t>(index);
  if (in_use && !words.online) {
    raise({ServoFault::Kind::DriveOffline, part, number, 0, 0});
  } else if (words.online && faulted(words)) {
    raise({ServoFault::Kind::DriveFault, part, number, static_cast<double>(words.error_code), 0});
  } else if (in_use && drive_state(words.statusword) != DriveState::OperationEnabled) {
    raise({ServoFault::Kind::DriveDropped, part, number, static_cast<double>(words.statusword), 0});
  }
}

void ServoLoop::Impl::watch_drives() noexcept {
  if (!driving()) return;
  std::uint32_t in_use = state == ServoState::Homing ? homing : 0;
  for (std::size_t j = 0; j < axes; ++j) {
    if (live[j]) in_use |= actuators_of[j];
  }
  for (std::size_t i = 0; i < actuators; ++i) {
    watch_drive(feedback(i), (in_use >> i & 1U) != 0, ServoFault::Part::Actuator, i);
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    watch_drive(spindle_feedback(i), state == ServoState::Engaged, ServoFault::Part::Spindle, i);
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

}  // namespace rmac
