#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

/// A statusword that belongs to the start of homing is in by then; before, it may still tell of the last one.
constexpr int kSettleCycles = 10;

}  // namespace

void ServoLoop::Impl::begin_homing_turn() noexcept {
  std::uint8_t next = 0;
  for (std::size_t i = 0; i < actuators; ++i) {
    const std::uint8_t turn = parts.actuators[i].homing_turn;
    if (turn > homing_turn && (next == 0 || turn < next)) next = turn;
  }
  if (next == 0) {
    // Their drives take torques again, and each loop engages where it finds its joint.
    if (!homing_ends) ++homings;
    state = ServoState::Enabling;
    waiting_cycles = 0;
    homing = 0;
    return;
  }
  homing_turn = next;
  waiting_cycles = 0;
  for (std::size_t i = 0; i < actuators; ++i) {
    if (parts.actuators[i].homing_turn != next) continue;
    homing |= std::uint32_t{1} << i;
    homing_cycles[i] = 0;
  }
  for (std::size_t j = 0; j < axes; ++j) {
    if ((actuators_of[j] & homing) == 0) continue;
    live[j] = handed[j] = false;
    effort[j] = 0;
  }
}

void ServoLoop::Impl::begin_homing() noexcept {
  state = ServoState::Homing;
  homing = 0;
  homing_turn = 0;
  homing_ends = false;
  begin_homing_turn();
}

bool ServoLoop::Impl::homing_done(std::size_t actuator) noexcept {
  const DriveFeedback& words = feedback(actuator);
  // Its counter will jump, and none of that is motion.
  seen[actuator] = false;
  history[actuator] = 0;
  if (words.mode != DriveMode::Homing) return false;
  ++homing_cycles[actuator];
  if (homing_cycles[actuator] <= kSettleCycles) return false;
  const bool rests = (words.statusword & statusword::kTargetReached) != 0;
  if (homing_ends) return rests;
  if ((words.statusword & statusword::kHomingError) != 0) {
    raise({ServoFault::Kind::HomingFailed, ServoFault::Part::Actuator, static_cast<std::uint32_t>(actuator),
           static_cast<double>(words.statusword), 0});
    return false;
  }
  return rests && (words.statusword & statusword::kHomingAttained) != 0;
}

void ServoLoop::Impl::run_homing(const ServoCommand& command) noexcept {
  if (state != ServoState::Homing) return;
  if (!command.home && !homing_ends) {
    homing_ends = true;
    for (std::size_t i = 0; i < actuators; ++i) homing_cycles[i] = 0;
    waiting_cycles = 0;
  }
  bool done = true;
  for (std::size_t i = 0; i < actuators; ++i) {
    if ((homing >> i & 1U) != 0) done = homing_done(i) && done;
  }
  if (state != ServoState::Homing) return;
  if (done) {
    if (homing_ends) homing_turn = UINT8_MAX;
    begin_homing_turn();
    return;
  }
  if (static_cast<double>(++waiting_cycles) * parts.period_s <= parts.homing_timeout_s) return;
  for (std::size_t i = 0; i < actuators; ++i) {
    if ((homing >> i & 1U) == 0 || homing_done(i)) continue;
    raise({ServoFault::Kind::HomingFailed, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i),
           static_cast<double>(feedback(i).statusword), parts.homing_timeout_s});
  }
}

void ServoLoop::Impl::command_homing(std::size_t actuator, DriveCommand& words) const noexcept {
  if (state != ServoState::Homing || (homing >> actuator & 1U) == 0) return;
  words.mode = DriveMode::Homing;
  // Homing starts with the rise of this bit in its mode, and ends with the fall.
  const bool starts = feedback(actuator).mode == DriveMode::Homing && !homing_ends;
  if (starts) words.controlword |= controlword::kStartHoming;
}

Expected<> ServoLoop::Impl::check_homing() const {
  for (std::size_t j = 0; j < axes; ++j) {
    std::size_t first = actuators;
    for (std::size_t i = 0; i < actuators; ++i) {
      if ((actuators_of[j] >> i & 1U) == 0) continue;
      if (first == actuators) first = i;
      if (parts.actuators[i].homing_turn == parts.actuators[first].homing_turn) continue;
      return failure(MinorCode::InvalidParameterValue, "servo loop: actuators " + std::to_string(first) + " and " +
                                                           std::to_string(i) + " move joint " + std::to_string(j) +
                                                           " together; they must home in the same turn");
    }
  }
  return {};
}

}  // namespace rmac
