#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

bool faulted(const DriveFeedback& words) noexcept {
  const DriveState state = drive_state(words.statusword);
  return state == DriveState::Fault || state == DriveState::FaultReactionActive;
}

}  // namespace

DriveWish ServoLoop::Impl::wish(ServoFault::Part part, std::size_t index) const noexcept {
  if (given_up(part, index)) return DriveWish::QuickStop;
  if (powered()) return DriveWish::Operational;
  const bool rested = rest[part == ServoFault::Part::Spindle ? actuators + index : index].reached;
  return state == ServoState::Off || rested ? DriveWish::Off : DriveWish::QuickStop;
}

void ServoLoop::Impl::let_go() noexcept {
  live.fill(false);
  for (ForceLoop& loop : force_loops) loop.restart();
  handed.fill(false);
  effort.fill(0);
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
      if (braking && !command.power && braked_s >= brake_s) {
        braking = false;
        let_go();
      }
      break;
  }
  home_before = command.home;
}

void ServoLoop::Impl::finish_reset() noexcept {
  // Without power there is no braking: what still moves is waited for. That ends, for a drive that does not brake is
  // given up in the end.
  if (!resetting || (state == ServoState::Faulted && !stands())) return;
  bool any = (inputs & parts.emergency_stop_inputs) != 0;
  if (!parts.virtual_mode) {
    for (std::size_t i = 0; i < actuators; ++i) any = any || faulted(feedback(i));
    for (std::size_t i = 0; i < parts.spindles.size(); ++i) any = any || faulted(spindle_feedback(i));
  }
  if (!any) {
    resetting = false;
    if (state == ServoState::Faulted) {
      state = ServoState::Off;
      braking = false;
      let_go();
      fault = {};
    }
  } else if (static_cast<double>(++waiting_cycles) * parts.period_s > parts.enable_timeout_s) {
    resetting = false;  // the drives keep their faults: their cause is still there
  }
}

}  // namespace rmac
