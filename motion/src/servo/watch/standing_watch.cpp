#include "servo/watch/standing_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "servo/joints/cycles_of.hpp"

namespace rmac {

namespace {

constexpr double kStandsS = 0.02;
constexpr int kStandsCycles = 5;  // which are more than answers that come late, or once not, explain
constexpr double kStandsWay = 1;  // mm or degrees that it was to go meanwhile
constexpr double kOfBound = 0.8;  // of MaxFollowingError: what it was to go where it left that sooner
constexpr double kStretchWay = 0.05, kStretchS = 0.001;
constexpr double kStandsShare = 0.25;  // of what it was to go, and was pushed to: what blocks it gives way
constexpr double kDeadShare = 0.01;    // of what it was to go: by whatever it was pushed
constexpr double kMostly = 2;          // times MaxAcceleration, that all its effort gives a joint that is free
constexpr double kHoldsIt = 0.15;      // of MaxEffort, that friction takes where it turns round
constexpr double kToAndFro = 1.5;      // of the way that is left of it
constexpr double kLeastRange = 0.1;    // of MaxFollowingError: a path that trembles by less is none to follow

constexpr int kRestsCycles = 5;                      // of the setpoint
constexpr double kFrozenEffort = 0.03;               // of MaxEffort, by which it changes meanwhile
constexpr double kAwayDigits = 10, kFarDigits = 50;  // that it was to go, where it is never still for long
constexpr double kFarEffort = 0.01;                  // which is enough where that was far
constexpr double kStillS = 0.1;                      // of an encoder whose last digit may rest, as a coarse one's
constexpr double kStillEffort = 0.2;                 // more than twice the friction, where the joint is to turn round

constexpr double kLimit = 0.98;     // of MaxEffort
constexpr double kLimitS = 0.1;     // for which it gives all that
constexpr double kLimitWay = 0.02;  // of what MaxAcceleration makes of that time from rest

}  // namespace

StandingWatch::StandingWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
    : joint_(&joint),
      index_(static_cast<std::uint32_t>(index)),
      period_s_(period_s),
      least_cycles_{cycles_of(kStandsS, period_s, kStandsCycles), cycles_of(kStretchS, period_s),
                    cycles_of(kLimitS, period_s)},
      digits_(dead_stop(joint.bounds.stop_deceleration, period_s), period_s) {}

void StandingWatch::rest(std::optional<double> position) noexcept {
  begun_ = false;
  if (position) {
    digits_.note(*position, 0);
  } else {
    digits_.lose();
  }
}

void StandingWatch::step(const ResponseSeen& seen, FaultSink& faults) noexcept {
  if (!begun_) {
    begun_ = true;
    digits_.begin(seen.position, seen.effort);
    at_limit_.cycles = 0;
    begin_limit(seen);
    set_before_ = seen.position_set;
    efforts_ = 0;
    begin_rest(seen);
    return;
  }
  if (digits_.same() == 0) set_still_ = seen.position_set;
  constexpr double kLatelyS = 0.5;
  const double efforts = std::min(static_cast<double>(++efforts_), kLatelyS / period_s_);
  effort_lately_ += (seen.effort - effort_lately_) / efforts;
  const double went = digits_.step_to(seen.position);
  if (seen.answered) digits_.note(seen.position, seen.effort);
  watch_digits(seen, faults);
  watch_way(seen, went, faults);
  watch_limit(seen, faults);
  set_before_ = seen.position_set;
}

void StandingWatch::watch_digits(const ResponseSeen& seen, FaultSink& faults) const noexcept {
  if (!(joint_->max_effort > 0) || digits_.same() < kStandsCycles) return;
  const double changed = digits_.effort_change() / joint_->max_effort;
  const double usual = digits_.usual_change() / joint_->max_effort;
  const double for_s = static_cast<double>(digits_.same()) * period_s_;
  const double away = seen.position_set - set_still_;
  const double digits_away = digits_.digit() > 0 ? std::abs(away) / digits_.digit() : 0;
  const bool noise_stopped = digits_.noisy() && digits_away > kAwayDigits;
  const double least = noise_stopped && digits_away > kFarDigits ? kFarEffort : kFrozenEffort;
  if (froze() || noise_stopped) {
    if (for_s < kStandsS || changed < std::clamp(2 * usual, least, kStillEffort)) return;
    raise_frozen(faults);
  } else if (!slips() && for_s >= kStillS && changed >= kStillEffort && std::abs(away) > 2 * digits_.digit()) {
    faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, away, for_s});
  }
}

void StandingWatch::begin_rest(const ResponseSeen& seen) noexcept {
  went_speed_ = free_speed_ = free_at_ = 0;
  set_rests_ = 0;
  stretched_ = 0;
  begin_stretch(seen);
}

void StandingWatch::begin_stretch(const ResponseSeen& seen) noexcept {
  latest_ = (latest_ + 1) % kMostStretches;
  stretched_ = std::min(stretched_ + 1, kMostStretches);
  Stretch& stretch = stretches_[latest_];
  stretch = {.from = set_before_};
  stretch.position.begin(seen.position);
  stretch.set.begin(set_before_);
  stretch.free.begin(free_at_);
}

/// All its effort gives a joint MaxAcceleration at least, and mostly much more.
void StandingWatch::push(const ResponseSeen& seen, double went) noexcept {
  if (!(joint_->max_effort > 0)) return;
  const double share = (seen.effort - effort_lately_) / joint_->max_effort;
  const double free = share - std::clamp(share, -kHoldsIt, kHoldsIt);
  constexpr double kSmoothsS = 0.01;  // a motor swings on its screw
  went_speed_ += (went / period_s_ - went_speed_) * std::min(1.0, period_s_ / kSmoothsS);
  // What is not pushed goes as it goes, and what is braked may well stand.
  if (free * free_speed_ <= 0) free_speed_ = free == 0 ? went_speed_ : 0;
  free_speed_ += kMostly * free * joint_->bounds.stop_deceleration * period_s_;
  const double wanted = std::abs(seen.position_set - set_before_) / period_s_;
  free_speed_ = std::clamp(free_speed_, -wanted, wanted);
  free_at_ += free_speed_ * period_s_;
  if (free != 0) ++stretches_[latest_].pushed;
}

StandingWatch::Stretch StandingWatch::lately(double way, std::int64_t least_cycles) const noexcept {
  Stretch all = stretches_[latest_];
  for (std::size_t k = 1; k < stretched_ && (all.way < way || all.cycles < least_cycles); ++k) {
    const Stretch& before = stretches_[(latest_ + kMostStretches - k) % kMostStretches];
    all.position.add(before.position);
    all.set.add(before.set);
    all.from = before.from;
    all.way += before.way;
    all.free.add(before.free);
    all.cycles += before.cycles;
    all.pushed += before.pushed;
  }
  return all;
}

bool StandingWatch::stands(const Stretch& stretch) noexcept {
  const bool is_pushed = 2 * stretch.pushed > stretch.cycles;
  const double way = is_pushed ? kStandsShare * std::min(stretch.set.width(), stretch.free.width()) : 0;
  return stretch.position.width() <= std::max(kDeadShare * stretch.set.width(), way);
}

void StandingWatch::watch_way(const ResponseSeen& seen, double went, FaultSink& faults) noexcept {
  Stretch& latest = stretches_[latest_];
  const double step = std::abs(seen.position_set - set_before_);
  set_rests_ = step == 0 ? set_rests_ + 1 : 0;
  const bool begins = stretched_ == 1 && latest.way == 0;
  if (set_rests_ > kRestsCycles || (step == 0 && begins)) return begin_rest(seen);
  latest.position.add(seen.position);
  latest.set.add(seen.position_set);
  latest.way += step;
  push(seen, went);
  latest.free.add(free_at_);
  ++latest.cycles;
  const double least_range = kLeastRange * joint_->max_following_error;
  const bool beside = std::abs(seen.position_set - seen.position) > least_range / 4;
  if (beside) {
    const double way = seen.out_of_bound ? std::min(kStandsWay, kOfBound * joint_->max_following_error) : kStandsWay;
    const Stretch all = lately(way, least_cycles_.stands);
    const bool long_enough = all.cycles >= least_cycles_.stands && all.way >= way;
    if (long_enough && all.set.width() >= least_range && stands(all)) raise_standing(all, seen, faults);
  }
  if (latest.way >= kStretchWay && latest.cycles >= least_cycles_.stretch) begin_stretch(seen);
}

void StandingWatch::raise_standing(const Stretch& stretch, const ResponseSeen& seen, FaultSink& faults) const noexcept {
  if (froze()) return raise_frozen(faults);
  if (slips()) return;
  // What is told is all the time for which it stands, as far as it is known.
  const Stretch longest = lately(std::numeric_limits<double>::infinity(), 0);
  const Stretch& told = stands(longest) ? longest : stretch;
  const double away = seen.position_set - told.from;
  const bool to_and_fro = told.way > kToAndFro * std::abs(away);
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, to_and_fro ? told.way : away,
                static_cast<double>(told.cycles) * period_s_});
}

void StandingWatch::raise_frozen(FaultSink& faults) const noexcept {
  faults.raise({ServoFault::Kind::EncoderFrozen, ServoFault::Part::Joint, index_,
                static_cast<double>(digits_.same()) * period_s_, digits_.effort_change()});
}

void StandingWatch::begin_limit(const ResponseSeen& seen) noexcept {
  at_limit_.set = seen.position_set;
  at_limit_.position.begin(seen.position);
}

void StandingWatch::watch_limit(const ResponseSeen& seen, FaultSink& faults) noexcept {
  const double acceleration = joint_->bounds.stop_deceleration;
  const double effort = std::max(std::abs(seen.effort), std::abs(seen.commanded));
  const bool at_limit = joint_->max_effort > 0 && effort >= kLimit * joint_->max_effort;
  if (!(acceleration > 0) || slips()) return;
  // What trembles at its limit is not at it in each cycle.
  at_limit_.cycles = std::max<std::int64_t>(0, at_limit_.cycles + (at_limit ? 1 : -2));
  if (at_limit_.cycles == 0) return begin_limit(seen);
  at_limit_.position.add(seen.position);
  if (at_limit_.cycles < least_cycles_.limit) return;
  if (at_limit_.position.width() > kLimitWay * acceleration * kLimitS * kLimitS / 2) {
    at_limit_.cycles = 1;
    return begin_limit(seen);
  }
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, seen.position_set - at_limit_.set,
                static_cast<double>(at_limit_.cycles) * period_s_});
}

}  // namespace rmac
