#include "gateway/simulators/vdrive/axis/position_targets.hpp"

namespace rmac::vdrive {

namespace {

constexpr std::uint16_t kNewSetpoint = 0x10, kAtOnce = 0x20, kRelative = 0x40;

}  // namespace

void PositionTargets::reset() noexcept {
  drop_next();
  asked_before_ = false;
}

void PositionTargets::drop_next() noexcept {
  next_.reset();
  acknowledges_ = false;
}

bool PositionTargets::control(std::uint16_t word, const Seen& seen) noexcept {
  const bool asks = (word & kNewSetpoint) != 0;
  const bool rises = asks && !asked_before_;
  asked_before_ = asks;
  if (!seen.active) {
    if (!asks) acknowledges_ = false;
    return false;
  }
  bool changed = false;
  if (rises && (!next_ || (word & kAtOnce) != 0)) {
    const double target = (word & kRelative) != 0 ? next_.value_or(target_) + seen.written : seen.written;
    changed = (word & kAtOnce) != 0 || seen.at_target || (!next_ && seen.at_rest);
    if (changed) {
      target_ = target;
      next_.reset();
    } else {
      next_ = target;
    }
    acknowledges_ = true;
  }
  if (!asks && !next_) acknowledges_ = false;
  return changed;
}

bool PositionTargets::arrive() noexcept {
  if (!next_) return false;
  target_ = *next_;
  next_.reset();
  if (!asked_before_) acknowledges_ = false;
  return true;
}

}  // namespace rmac::vdrive
