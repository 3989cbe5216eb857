#include "servo/state/loop_state.hpp"

#include <utility>

namespace rmac {

namespace {

/// A stop that keeps power may have begun without the sensor, or beyond the bound: such faults do not end it. They are
/// those that a category is chosen for, but for a second silent drive.
bool allows_braking(const ServoFault& found) noexcept {
  switch (found.kind) {
    case ServoFault::Kind::ForceLimit:
    case ServoFault::Kind::ContactLost:
    case ServoFault::Kind::CyclesLost:
      return true;
    case ServoFault::Kind::SensorLost:
      return found.part == ServoFault::Part::Joint;
    case ServoFault::Kind::TorqueBound:
      return found.part == ServoFault::Part::Spindle;
    default:
      return false;
  }
}

}  // namespace

void LoopState::enable() noexcept {
  state_ = ServoState::Enabling;
  enabling_cycles_ = 0;
}

void LoopState::obey(const ServoCommand& command, bool braked) noexcept {
  if (command.reset && !reset_before_) {
    resetting_ = true;
    resetting_cycles_ = 0;
    enabling_cycles_ = 0;  // what is reset may take its time once more
  }
  reset_before_ = command.reset;
  if (!command.power) power_spent_ = false;

  switch (state_) {
    case ServoState::Off:
      if (command.power && !power_spent_ && !command.quick_stop && !resetting_) enable();
      break;
    case ServoState::Enabling:
    case ServoState::Engaged:
    case ServoState::Homing:
      leave_engaged(command);
      break;
    case ServoState::QuickStop:
      if (!command.quick_stop && !command.power) state_ = ServoState::Off;
      break;
    case ServoState::Faulted:
      if (!command.power && braked) braking_ = false;
      break;
  }
  home_before_ = command.home;
}

void LoopState::leave_engaged(const ServoCommand& command) noexcept {
  if (command.quick_stop) {
    state_ = ServoState::QuickStop;
    power_spent_ = true;
  } else if (!command.power) {
    state_ = ServoState::Off;
  } else if (state_ == ServoState::Engaged && command.home && !home_before_ && !parts_.virtual_mode) {
    state_ = ServoState::Homing;
  } else if (parts_.virtual_mode && enabling_cycles_++ > 0) {
    state_ = ServoState::Engaged;
  }
}

void LoopState::finish_reset(bool stands, bool clear) noexcept {
  // Without power there is no braking: what still moves is waited for. That ends, for a drive that does not brake is
  // given up in the end.
  if (!resetting_ || (state_ == ServoState::Faulted && !stands)) return;
  if (!clear) {
    // After that time the drives keep their faults: their cause is still there.
    resetting_ = static_cast<double>(++resetting_cycles_) * parts_.period_s <= parts_.enable_timeout_s;
    return;
  }
  resetting_ = false;
  if (state_ != ServoState::Faulted) return;
  state_ = ServoState::Off;
  braking_ = false;
  fault_ = {};
}

void LoopState::arrive(bool all_live) noexcept {
  if (state_ == ServoState::Enabling && all_live) {
    state_ = ServoState::Engaged;
  } else {
    follows_ = state_ == ServoState::Engaged;
  }
}

bool LoopState::enables_too_long() noexcept {
  if (state_ != ServoState::Enabling) return false;
  return static_cast<double>(++enabling_cycles_) * parts_.period_s > parts_.enable_timeout_s;
}

void LoopState::raise(const ServoFault& found) noexcept {
  const bool graver = found.kind == ServoFault::Kind::EmergencyStop && fault_.kind != found.kind;
  if (state_ == ServoState::Faulted && !graver) {
    if (!braking_ || allows_braking(found)) return;
    // Whatever else goes wrong on the way takes the choice away.
    braking_ = false;
    fault_.stop = StopCategory::StopThenRemovePower;
    return;
  }
  fault_ = found;
  fault_.stop = stop_category(found);
  braking_ = fault_.stop == StopCategory::StopKeepPower;
  state_ = ServoState::Faulted;
  new_stop_ = true;
  power_spent_ = true;
  follows_ = false;
}

bool LoopState::take_new_stop() noexcept {
  return std::exchange(new_stop_, false);
}

// Joints that are not all held, and a drive that has lost its encoder, cannot be braked by this loop.
StopCategory LoopState::stop_category(const ServoFault& found) const noexcept {
  const bool encoder_lost = found.kind == ServoFault::Kind::SensorLost && found.part != ServoFault::Part::Joint;
  const bool may_choose = state_ == ServoState::Engaged && !encoder_lost;
  return may_choose ? chosen_category(found) : StopCategory::StopThenRemovePower;
}

StopCategory LoopState::chosen_category(const ServoFault& found) const noexcept {
  const StopCategories& chosen = parts_.stop_categories;
  switch (found.kind) {
    case ServoFault::Kind::SensorLost:
      return chosen.sensor_lost;
    case ServoFault::Kind::ForceLimit:
      return chosen.force_limit;
    case ServoFault::Kind::ContactLost:
      return chosen.contact_lost;
    case ServoFault::Kind::CyclesLost:
      return chosen.cycles_lost;
    case ServoFault::Kind::DriveOffline:
      return can_do_without(found) ? chosen.drive_silent : StopCategory::StopThenRemovePower;
    case ServoFault::Kind::TorqueBound:
      return found.part == ServoFault::Part::Spindle ? chosen.spindle_overload : StopCategory::StopThenRemovePower;
    default:
      return StopCategory::StopThenRemovePower;
  }
}

// Nothing but a spindle, or a joint of its own, hangs on the drive that is silent.
bool LoopState::can_do_without(const ServoFault& found) const noexcept {
  if (found.part != ServoFault::Part::Actuator) return found.part == ServoFault::Part::Spindle;
  return wiring_.alone(found.index);
}

bool LoopState::given_up(ServoFault::Part part, std::size_t index) const noexcept {
  return braking_ && fault_.kind == ServoFault::Kind::DriveOffline && fault_.part == part && fault_.index == index;
}

std::optional<std::size_t> LoopState::actuator_given_up() const noexcept {
  if (!given_up(ServoFault::Part::Actuator, fault_.index)) return std::nullopt;
  return fault_.index;
}

}  // namespace rmac
