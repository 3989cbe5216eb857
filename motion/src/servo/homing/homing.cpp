#include "servo/homing/homing.hpp"

#include <cstdlib>

#include "rmac/motion/drive_power.hpp"

namespace rmac {

namespace {

/// A statusword that belongs to the start of homing is in by then; before, it may still tell of the last one.
constexpr int kSettleCycles = 10;
/// A drive stands when its count has stayed the same for so long, but for the noise of its encoder.
constexpr double kStandsFor_s = 0.1;
constexpr std::int64_t kNoise_counts = 2;

}  // namespace

Homing::Progress Homing::begin() noexcept {
  drives_ = 0;
  turn_ = 0;
  ends_ = false;
  return begin_turn();
}

Homing::Progress Homing::begin_turn() noexcept {
  std::uint8_t next = 0;
  for (const ServoActuator& actuator : actuators_) {
    if (actuator.homing_turn > turn_ && (next == 0 || actuator.homing_turn < next)) next = actuator.homing_turn;
  }
  if (next == 0 || ends_) {
    if (!ends_) ++completed_;
    drives_ = 0;
    return Progress::Over;
  }
  turn_ = next;
  waited_cycles_ = 0;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (actuators_[i].homing_turn != next) continue;
    drives_ |= only(i);
    cycles_[i] = 0;
  }
  return Progress::UnderWay;
}

Homing::Progress Homing::look(std::size_t actuator, Shafts& shafts, FaultSink& faults) noexcept {
  shafts[actuator].forget();
  const DriveFeedback& told = words(actuator);
  if (told.mode != DriveMode::Homing) return Progress::UnderWay;
  if (++cycles_[actuator] <= kSettleCycles) return Progress::UnderWay;
  const bool rests = (told.statusword & statusword::kTargetReached) != 0;
  if (ends_) return rests || stands(actuator) ? Progress::Over : Progress::UnderWay;
  if ((told.statusword & statusword::kHomingError) != 0) {
    raise(actuator, 0, faults);
    return Progress::Failed;
  }
  const bool attained = (told.statusword & statusword::kHomingAttained) != 0;
  return rests && attained ? Progress::Over : Progress::UnderWay;
}

bool Homing::stands(std::size_t actuator) noexcept {
  const DriveFeedback& told = words(actuator);
  if (!told.online || told.missed) return false;
  Standing& seen = standing_[actuator];
  if (std::abs(std::int64_t{told.position_counts} - seen.counts) > kNoise_counts) seen = {told.position_counts, 0};
  return static_cast<double>(++seen.cycles) * period_s_ > kStandsFor_s;
}

Homing::Progress Homing::step(bool wanted, Shafts& shafts, FaultSink& faults) noexcept {
  if (!wanted && !ends_) {
    ends_ = true;
    cycles_.fill(0);
    standing_.fill({});
    waited_cycles_ = 0;
  }
  IndexSet under_way = 0;
  bool failed = false;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (!has(drives_, i)) continue;
    const Progress progress = look(i, shafts, faults);
    if (progress == Progress::UnderWay) under_way |= only(i);
    if (progress == Progress::Failed) failed = true;
  }
  if (failed) return Progress::Failed;
  if (under_way == 0) return begin_turn();
  if (static_cast<double>(++waited_cycles_) * period_s_ <= timeout_s_) return Progress::UnderWay;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (has(under_way, i)) raise(i, timeout_s_, faults);
  }
  return Progress::Failed;
}

void Homing::raise(std::size_t actuator, double bound, FaultSink& faults) const noexcept {
  faults.raise({ServoFault::Kind::HomingFailed, ServoFault::Part::Actuator, static_cast<std::uint32_t>(actuator),
                static_cast<double>(words(actuator).statusword), bound});
}

void Homing::command(std::size_t actuator, DriveCommand& words) const noexcept {
  if (!has(drives_, actuator)) return;
  words.mode = DriveMode::Homing;
  // Homing starts with the rise of this bit in its mode, and ends with the fall.
  const bool starts = this->words(actuator).mode == DriveMode::Homing && !ends_;
  if (starts) words.controlword |= controlword::kStartHoming;
}

}  // namespace rmac
