#include "servo/spindles/turn_reader.hpp"

#include <algorithm>

namespace rmac {

void TurnReader::read(const DriveFeedback& words) noexcept {
  if (!words.online) {
    history_ = 0;
    return;
  }
  const std::int32_t moved = counts_gone(last_counts_, words.position_counts);
  last_counts_ = words.position_counts;
  if (seen_) counts_ += moved;
  seen_ = true;
  const double before = step_;
  step_ = shaft_turns(scale_, moved);
  if (history_ > 0) {
    const double now = (history_ == 1 ? step_ : (3 * step_ - before) / 2) / period_s_ * 60;
    rpm_per_s_ = history_ == 1 ? 0 : (now - rpm_) / period_s_;
    rpm_ = now;
  }
  history_ = static_cast<std::uint8_t>(std::min(history_ + 1, 2));
}

}  // namespace rmac
