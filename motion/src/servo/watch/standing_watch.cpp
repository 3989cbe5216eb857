#include "servo/watch/standing_watch.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

namespace {

constexpr double kStandsS = 0.02;
constexpr int kStandsCycles = 5;       // which are more than answers that come late, or once not, explain
constexpr double kStandsWay = 1;       // mm or degrees that it was to go meanwhile
constexpr double kStandsShare = 0.25;  // of what it was to go: what blocks it gives way
constexpr double kToAndFro = 1.5;      // of the way that is left of it
constexpr double kLeastRange = 0.1;    // of MaxFollowingError: a path that trembles by less is none to follow

constexpr int kDigitTurns = 12;         // of the last digit: it is never quite still
constexpr int kRests = 5;               // cycles: then it is
constexpr double kDeadStop = 10;        // of MaxAcceleration within a cycle: no brake and no wall does that
constexpr double kFrozenEffort = 0.03;  // of MaxEffort, by which it changes meanwhile
constexpr double kStillS = 0.1;         // of an encoder whose last digit may rest, as a coarse one's
constexpr double kStillEffort = 0.2;    // more than twice the friction, where the joint is to turn round

constexpr double kLimit = 0.98;     // of MaxEffort
constexpr double kLimitS = 0.1;     // for which it gives all that
constexpr double kLimitWay = 0.02;  // of what MaxAcceleration makes of that time from rest

}  // namespace

void StandingWatch::rest() noexcept {
  begun_ = false;
  stands_ = at_limit_ = 0;
}

void StandingWatch::rest(double position) noexcept {
  rest();
  note_digits(position, 0);
}

std::int64_t StandingWatch::cycles(double seconds) const noexcept {
  return static_cast<std::int64_t>(std::ceil(seconds / period_s_ - 1e-9));
}

bool StandingWatch::froze() const noexcept {
  constexpr double kNoticedS = 0.003;
  return (turns_ >= kDigitTurns || stopped_dead_) && same_ >= std::max<std::int64_t>(3, cycles(kNoticedS));
}

void StandingWatch::begin_way(const ResponseSeen& seen) noexcept {
  position_.begin(seen.position);
  set_.begin(seen.position_set);
  set_at_ = seen.position_set;
  way_ = 0;
  stands_ = 0;
}

void StandingWatch::step(const ResponseSeen& seen, FaultSink& faults) noexcept {
  if (!begun_) {
    begun_ = true;
    digits_ = seen.position;
    same_ = 0;
    stopped_dead_ = false;
    set_before_ = seen.position_set;
    effort_.begin(seen.effort);
    begin_way(seen);
    return;
  }
  if (same_ == 0) set_still_ = seen.position_set;
  if (seen.answered) note_digits(seen.position, seen.effort);
  watch_digits(seen, faults);
  watch_way(seen, faults);
  watch_limit(seen, faults);
  set_before_ = seen.position_set;
}

void StandingWatch::note_digits(double position, double effort) noexcept {
  const double step = position - digits_;
  digits_ = position;
  if (step == 0) {
    const double acceleration = joint_->bounds.stop_deceleration;
    if (same_++ == 0) {
      stopped_dead_ = acceleration > 0 && std::abs(last_step_) > kDeadStop * acceleration * period_s_ * period_s_;
    }
    effort_.add(effort);
    return;
  }
  if (same_ > kRests) turns_ = 0;
  if (step * last_step_ < 0) turns_ = std::min(turns_ + 1, kDigitTurns);
  last_step_ = step;
  same_ = 0;
  stopped_dead_ = false;
  effort_.begin(effort);
}

void StandingWatch::watch_digits(const ResponseSeen& seen, FaultSink& faults) const noexcept {
  if (!(joint_->max_effort > 0) || same_ < kStandsCycles) return;
  const double changed = effort_.width() / joint_->max_effort;
  const double for_s = static_cast<double>(same_) * period_s_;
  if (froze()) {
    if (for_s < kStandsS || changed < kFrozenEffort) return;
    raise_frozen(faults);
  } else if (for_s >= kStillS && changed >= kStillEffort && seen.position_set != set_still_) {
    faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, seen.position_set - set_at_, for_s});
  }
}

void StandingWatch::watch_way(const ResponseSeen& seen, FaultSink& faults) noexcept {
  position_.add(seen.position);
  set_.add(seen.position_set);
  if (position_.width() > kStandsShare * set_.width()) return begin_way(seen);
  const double step = std::abs(seen.position_set - set_before_);
  if (step == 0 && way_ == 0) {
    begin_way(seen);  // as it is to
    return;
  }
  way_ += step;
  ++stands_;
  if (stands_ < std::max<std::int64_t>(kStandsCycles, cycles(kStandsS))) return;
  if (set_.width() < kLeastRange * joint_->max_following_error) return;
  if (way_ < kStandsWay && !seen.out_of_bound) return;
  if (froze()) return raise_frozen(faults);
  const double away = seen.position_set - set_at_;
  const bool to_and_fro = way_ > kToAndFro * std::abs(away);
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, to_and_fro ? way_ : away,
                static_cast<double>(stands_) * period_s_});
}

void StandingWatch::raise_frozen(FaultSink& faults) const noexcept {
  faults.raise({ServoFault::Kind::EncoderFrozen, ServoFault::Part::Joint, index_,
                static_cast<double>(same_) * period_s_, effort_.width()});
}

void StandingWatch::watch_limit(const ResponseSeen& seen, FaultSink& faults) noexcept {
  const double acceleration = joint_->bounds.stop_deceleration;
  const bool at_limit = joint_->max_effort > 0 && std::abs(seen.effort) >= kLimit * joint_->max_effort;
  if (!(acceleration > 0)) return;
  // What trembles at its limit is not at it in each cycle.
  at_limit_ = std::max<std::int64_t>(0, at_limit_ + (at_limit ? 1 : -2));
  if (at_limit_ == 0) return pushed_.begin(seen.position);
  pushed_.add(seen.position);
  if (at_limit_ < cycles(kLimitS) || pushed_.width() > kLimitWay * acceleration * kLimitS * kLimitS / 2) return;
  faults.raise({ServoFault::Kind::StandsStill, ServoFault::Part::Joint, index_, seen.position_set - set_at_,
                static_cast<double>(at_limit_) * period_s_});
}

}  // namespace rmac
