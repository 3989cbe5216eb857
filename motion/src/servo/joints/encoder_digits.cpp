#include "servo/joints/encoder_digits.hpp"

#include <algorithm>
#include <cmath>

#include "servo/joints/cycles_of.hpp"

namespace rmac {

namespace {

constexpr int kTurns = 12;         // of the last digit: it is never quite still
constexpr double kRestsS = 0.005;  // then it is
constexpr int kRestsCycles = 5;
constexpr double kNoticedS = 0.003;
constexpr int kNoticedCycles = 3;
constexpr double kNoStep = 1e-9;  // what a transmission rounds
constexpr double kFastDigits = 5;
// Who turns round against its friction has twice what it was pulled loose with, and stick-slip takes a tenth of that. A
// coarse digit that goes to and fro as well, because its loop hunts, takes as much each time.
constexpr double kManyTimes = 20;

}  // namespace

EncoderDigits::EncoderDigits(double fast, double period_s) noexcept
    : fast_(fast),
      rests_cycles_(cycles_of(kRestsS, period_s, kRestsCycles)),
      noticed_cycles_(cycles_of(kNoticedS, period_s, kNoticedCycles)) {}

void EncoderDigits::begin(double position, double effort) noexcept {
  last_ = position;
  last_step_ = 0;
  same_ = fast_cycles_ = 0;
  stopped_dead_ = false;
  effort_.begin(effort);
}

void EncoderDigits::note(double position, double effort) noexcept {
  const double step = step_to(position);
  last_ = position;
  if (step == 0) {
    if (same_++ == 0) stopped_dead_ = fast_cycles_ > 1;
    fast_cycles_ = 0;
    effort_.add(effort);
    return;
  }
  if (same_ > rests_cycles_) {
    turns_ = 0;
    usual_ = std::max(usual_, effort_.width());
  }
  note_step(step);
  same_ = 0;
  stopped_dead_ = false;
  effort_.begin(effort);
}

void EncoderDigits::note_step(double step) noexcept {
  if (std::abs(step) > kNoStep) digit_ = digit_ > 0 ? std::min(digit_, std::abs(step)) : std::abs(step);
  if (step * last_step_ < 0) {
    turns_ = std::min(turns_ + 1, kTurns);
    turns_at_all_ = std::min(turns_at_all_ + 1, kTurns);
  }
  const bool fast = fast_ > 0 && std::abs(step) > std::max(fast_, kFastDigits * digit_) && step * last_step_ > 0;
  fast_cycles_ = fast ? std::min(fast_cycles_ + 1, 2) : 0;
  last_step_ = step;
}

bool EncoderDigits::never_rested_so() const noexcept {
  return turns_at_all_ >= kTurns && same_ > rests_cycles_ && effort_.width() >= kManyTimes * usual_;
}

bool EncoderDigits::froze() const noexcept {
  return (turns_ >= kTurns || stopped_dead_) && same_ >= noticed_cycles_;
}

}  // namespace rmac
