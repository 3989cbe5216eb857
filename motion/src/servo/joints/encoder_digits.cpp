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
constexpr double kNoisyDigits = 1.9;  // a digit at whose edge it stands flickers by one
constexpr int kNoisyTurns = 6;

}  // namespace

EncoderDigits::EncoderDigits(double fast, double period_s) noexcept
    : fast_(fast),
      rests_cycles_(cycles_of(kRestsS, period_s, kRestsCycles)),
      noticed_cycles_(cycles_of(kNoticedS, period_s, kNoticedCycles)) {}

void EncoderDigits::begin(double position, double effort) noexcept {
  last_ = position;
  last_step_ = 0;
  noisy_turns_ = 0;
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
  const bool turns = step * last_step_ < 0;
  if (turns) turns_ = std::min(turns_ + 1, kTurns);
  const double least = kNoisyDigits * digit_;
  if (turns && std::min(std::abs(step), std::abs(last_step_)) > least)
    noisy_turns_ = std::min(noisy_turns_ + 1, kNoisyTurns);
  const bool fast = fast_ > 0 && std::abs(step) > std::max(fast_, kFastDigits * digit_) && step * last_step_ > 0;
  fast_cycles_ = fast ? std::min(fast_cycles_ + 1, 2) : 0;
  last_step_ = step;
}

bool EncoderDigits::noisy() const noexcept {
  return noisy_turns_ >= kNoisyTurns;
}

bool EncoderDigits::froze() const noexcept {
  return (turns_ >= kTurns || stopped_dead_) && same_ >= noticed_cycles_;
}

}  // namespace rmac
