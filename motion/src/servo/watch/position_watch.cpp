#include "servo/watch/position_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rmac {

namespace {

/// Answers on end that have to agree where a bus cannot read a position beside them.
constexpr int kAgreeing = 3;
/// Cycles that pass on the way of a reading, beside those that it is waited for.
constexpr int kOnTheWay = 3;
/// Unanswered cycles in which a joint may have moved on; a longer silence is none.
constexpr int kMostMissed = 3;
/// A drive that loses its master goes on for so long before it brakes.
constexpr double kNoticesS = 0.2;
/// A joint's speed fades by so much a cycle: how fast it was a moment ago counts.
constexpr double kFades = 0.9;

}  // namespace

PositionWatch::PositionWatch(const ServoLoopParts& parts, const Wiring& wiring)
    : parts_(parts), wiring_(wiring), late_answers_(wiring.actuator_delays()) {
  doubtful_ = unsettled_ = first(wiring_.actuators());
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (parts_.actuators[i].homing_turn == 0) referenced_ |= only(i);
  }
}

double PositionWatch::reach(std::size_t joint, int cycles) const noexcept {
  const JointBounds& bounds = parts_.joints[joint].bounds;
  if (!(bounds.velocity > 0) || !(bounds.jump > 0)) return std::numeric_limits<double>::infinity();
  return bounds.velocity * parts_.period_s * cycles + bounds.jump;
}

PositionWatch::JointArray PositionWatch::joints_at(std::span<const double> shafts) const noexcept {
  JointArray joints{};
  parts_.actuator_map->joint_positions(shafts, {joints.data(), wiring_.joints()});
  return joints;
}

void PositionWatch::doubt(std::size_t actuator, bool unsettles) noexcept {
  if (!has(doubtful_, actuator)) doubts_[actuator] = {.reads = told(actuator).position_reads};
  doubtful_ |= only(actuator);
  if (unsettles) unsettled_ |= only(actuator);
}

void PositionWatch::notice_loss(std::size_t actuator) noexcept {
  const IndexSet joints = wiring_.joints_of(only(actuator));
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (!has(joints, j)) continue;
    const double deceleration = parts_.joints[j].bounds.stop_deceleration;
    joints_[j].coasting = joints_[j].speed * kNoticesS +
                          (deceleration > 0 ? joints_[j].speed * joints_[j].speed / deceleration : joints_[j].speed);
  }
}

void PositionWatch::step(Shafts& shafts, std::span<const double> velocity, std::uint64_t missed) noexcept {
  late_answers_.step(missed);
  jumped_ = 0;
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    joints_[j].speed = std::max(std::abs(velocity[j]), kFades * joints_[j].speed);
  }
  IndexSet online = 0, silent = 0;
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (told(i).online) online |= only(i);
    if (told(i).online && !has(online_, i)) doubts_[i].reads = told(i).position_reads;
    if (told(i).online && !told(i).missed) continue;
    silent |= only(i);
    doubt(i, !told(i).online);
    doubts_[i].missed = std::min(doubts_[i].missed + 1, kMostMissed);
    if (!told(i).online && has(online_, i)) notice_loss(i);
  }
  online_ = online;
  answered_ = ~wiring_.joints_of(silent);
  JointArray now = joints_at(shafts.rad());
  judge(now, static_cast<int>(std::min<std::uint64_t>(late_answers_.now(), kMostMissed)), shafts);
  const bool put_elsewhere = held_ != 0;  // refused, or about to be believed
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (!has(online, i)) continue;
    if (has(doubtful_, i) && !told(i).missed) resolve(i, shafts);
    known_ |= only(i);
    if (!told(i).missed && !has(held_, i)) doubts_[i].missed = 0;
  }
  if (put_elsewhere) now = joints_at(shafts.rad());
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    joints_[j].step = now[j] - joints_[j].last;
    joints_[j].last = now[j];
  }
  forgotten_ = 0;
}

void PositionWatch::judge(const JointArray& now, int late, Shafts& shafts) noexcept {
  IndexSet unexplained = 0;
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    const IndexSet actuators = wiring_.actuators_of(j);
    if ((actuators & ~known_) != 0 || (actuators & online_) == 0) continue;
    int cycles = 1;
    for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
      if (has(actuators, i)) cycles = std::max(cycles, 1 + doubts_[i].missed);
    }
    const double step = now[j] - joints_[j].last;
    if (std::abs(step) <= reach(j, cycles + late)) continue;
    unexplained |= actuators & online_;
    jumped_ |= only(j);
    joints_[j].jump = step - joints_[j].step;
  }
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (!has(unexplained, i)) continue;
    doubt(i, true);
    shafts.refuse(i);
  }
  held_ = (held_ & ~online_) | unexplained;
}

double PositionWatch::difference(std::size_t joint, const Shafts& shafts, std::size_t actuator, std::int32_t one,
                                 std::int32_t other) const noexcept {
  std::array<double, kMaxJoints> at{};
  std::copy(shafts.rad().begin(), shafts.rad().end(), at.begin());
  const std::span<const double> all(at.data(), wiring_.actuators());
  at[actuator] = shafts[actuator].rad_at(one);
  const double from = joints_at(all)[joint];
  at[actuator] = shafts[actuator].rad_at(other);
  return joints_at(all)[joint] - from;
}

bool PositionWatch::agree(const Shafts& shafts, std::size_t actuator, std::int32_t one, std::int32_t other,
                          int cycles) noexcept {
  const IndexSet joints = wiring_.joints_of(only(actuator));
  bool agreed = true;
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (!has(joints, j)) continue;
    const double apart = difference(j, shafts, actuator, one, other);
    if (std::abs(apart) <= reach(j, cycles)) continue;
    agreed = false;
    jumped_ |= only(j);
    joints_[j].jump = apart;
  }
  return agreed;
}

void PositionWatch::resolve(std::size_t actuator, Shafts& shafts) noexcept {
  const DriveFeedback& words = told(actuator);
  Doubt& doubt = doubts_[actuator];
  if (parts_.actuators[actuator].bus->interface->reads_positions(parts_.actuators[actuator].axis)) {
    ++doubt.waited;
    if (words.position_reads == doubt.reads) return;
    doubt.reads = words.position_reads;
    const int cycles = std::exchange(doubt.waited, 0) + kOnTheWay;
    if (agree(shafts, actuator, words.position_read_counts, words.position_counts, cycles)) believe(actuator, shafts);
    return;
  }
  if (has(held_, actuator)) {
    const bool same = doubt.candidate && agree(shafts, actuator, *doubt.candidate, words.position_counts, 1);
    doubt.repeated = same ? doubt.repeated + 1 : 0;
    doubt.candidate = words.position_counts;
    if (doubt.repeated < kAgreeing) return;
  }
  believe(actuator, shafts);
}

void PositionWatch::believe(std::size_t actuator, Shafts& shafts) noexcept {
  if (has(held_, actuator)) {
    const JointArray before = joints_at(shafts.rad());
    shafts.put_at(actuator, told(actuator));
    const JointArray after = joints_at(shafts.rad());
    const IndexSet joints = has(believed_, actuator) ? wiring_.joints_of(only(actuator)) : 0;
    for (std::size_t j = 0; j < wiring_.joints(); ++j) {
      if (has(joints, j)) joints_[j].displaced += after[j] - before[j];
    }
  }
  held_ &= ~only(actuator);
  doubtful_ &= ~only(actuator);
  unsettled_ &= ~only(actuator);
  believed_ |= only(actuator);
  doubts_[actuator] = {};
}

void PositionWatch::forget(IndexSet actuators) noexcept {
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (has(actuators, i)) doubt(i, true);
  }
  known_ &= ~actuators;
  believed_ &= ~actuators;
  held_ &= ~actuators;
  referenced_ &= ~actuators;
  forgotten_ |= actuators;
}

void PositionWatch::homed() noexcept {
  IndexSet found = 0;
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
    if (parts_.actuators[i].homing_turn > 0) found |= only(i);
  }
  referenced_ |= found;
  lost_ &= ~wiring_.joints_of(found);
}

PositionWatch::Known PositionWatch::known(std::size_t actuator) const noexcept {
  IndexSet lost = lost_;
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (displaced(j)) lost |= only(j);
  }
  return {.believed = has(believed_, actuator),
          .referenced = has(referenced_, actuator),
          .lost = (wiring_.joints_of(only(actuator)) & lost) != 0};
}

void PositionWatch::take_over(std::size_t actuator, const Known& before, bool live) noexcept {
  if (before.believed) {
    known_ |= only(actuator);
    believed_ |= only(actuator);
  }
  if (before.referenced) referenced_ |= only(actuator);
  if (before.lost) lost_ |= wiring_.joints_of(only(actuator));
  if (!live) return;
  doubtful_ &= ~only(actuator);
  unsettled_ &= ~only(actuator);
}

void PositionWatch::go_on_from(const Shafts& shafts) noexcept {
  std::array<double, kMaxJoints> at{};
  for (std::size_t i = 0; i < wiring_.actuators(); ++i) at[i] = shafts[i].rad();
  const JointArray joints = joints_at({at.data(), wiring_.actuators()});
  for (std::size_t j = 0; j < wiring_.joints(); ++j) joints_[j].last = joints[j];
}

bool PositionWatch::displaced(std::size_t joint) const noexcept {
  const double jump = parts_.joints[joint].bounds.jump;
  if (!(jump > 0) || !referenced(joint)) return false;
  return std::abs(joints_[joint].displaced) > jump + joints_[joint].coasting;
}

void PositionWatch::check_standing(IndexSet live, FaultSink& faults) noexcept {
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    const bool unsettled = (wiring_.actuators_of(j) & unsettled_) != 0;
    if (has(live, j) || unsettled || !displaced(j)) continue;
    displaced_joints_ |= only(j);
    faults.raise({ServoFault::Kind::Displaced, ServoFault::Part::Joint, static_cast<std::uint32_t>(j),
                  joints_[j].displaced, parts_.joints[j].bounds.jump + joints_[j].coasting});
  }
}

void PositionWatch::check_aims(std::span<const double> aims, std::span<const double> shafts, IndexSet joints,
                               FaultSink& faults) noexcept {
  if (joints == 0) return;
  const JointArray aimed = joints_at(aims), stand = joints_at(shafts);
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    const double jump = parts_.joints[j].bounds.jump;
    const double step = aimed[j] - stand[j];
    if (!has(joints, j) || !(jump > 0) || std::abs(step) <= jump) continue;
    faults.raise({ServoFault::Kind::Displaced, ServoFault::Part::Joint, static_cast<std::uint32_t>(j), step, jump});
  }
}

void PositionWatch::engaged(std::size_t joint) noexcept {
  joints_[joint].displaced = 0;
  joints_[joint].coasting = 0;
}

IndexSet PositionWatch::forgive(const ServoFault& fault) noexcept {
  IndexSet without = displaced_joints_ | std::exchange(suspected_, 0);
  if (fault.kind == ServoFault::Kind::EncoderJump || fault.kind == ServoFault::Kind::EncoderFrozen ||
      fault.kind == ServoFault::Kind::Displaced) {
    if (fault.part == ServoFault::Part::Joint) without |= only(fault.index);
    if (fault.part == ServoFault::Part::Actuator) without |= wiring_.joints_of(only(fault.index));
  }
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (!has(without, j)) continue;
    joints_[j].displaced = 0;
    if (!referenced(j)) continue;
    lost_ |= only(j);
    for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
      if (has(wiring_.actuators_of(j), i) && parts_.actuators[i].homing_turn > 0) referenced_ &= ~only(i);
    }
  }
  displaced_joints_ = 0;
  return without;
}

}  // namespace rmac
