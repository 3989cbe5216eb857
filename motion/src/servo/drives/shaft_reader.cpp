#include "servo/drives/shaft_reader.hpp"

#include <algorithm>

namespace rmac {

// A loop that took the shaft to stand for a cycle would brake it with all its effort, and push as hard in the next.
bool ShaftReader::goes_on(const DriveFeedback& words) noexcept {
  constexpr std::uint8_t kMost = 3;
  if (!words.missed || !seen_) return false;
  counts_before_ = counts_;
  if (gone_on_ == kMost) {
    rad_s_ = 0;
    history_ = 0;
    return true;
  }
  ++gone_on_;
  rad_before_ = rad_;
  rad_ += rad_s_ * period_s_;
  return true;
}

// Over the cycles without an answer its speed changed steadily, from what it was to what it is.
void ShaftReader::come_back(double now) noexcept {
  const double cycles = gone_on_ + 1;
  const double gone = now - (rad_ - (cycles - 1) * rad_s_ * period_s_);
  const double step = 2 * gone / cycles - rad_s_ * period_s_;
  rad_ = now - step;
  rad_before_ = rad_ - step;
}

void ShaftReader::read(const DriveFeedback& words) noexcept {
  if (!words.online) {
    history_ = 0;
    rad_s_ = 0;
    return;
  }
  if (goes_on(words)) return;
  const std::int64_t last = seen_ ? counts_ : std::int64_t{scale_.home_counts};
  counts_before_ = last;
  counts_ = last + counts_gone(last, words.position_counts);
  const double now = shaft_rad(scale_, static_cast<double>(counts_));
  if (gone_on_ > 0 && history_ > 0) come_back(now);
  gone_on_ = 0;
  const double back1 = now - rad_;
  const double back2 = rad_ - rad_before_;
  const double moved = history_ == 0 ? 0 : history_ == 1 ? back1 : (3 * back1 - back2) / 2;
  rad_s_ = moved / period_s_;
  history_ = static_cast<std::uint8_t>(std::min(history_ + 1, 2));
  rad_before_ = rad_;
  rad_ = now;
  seen_ = true;
}

void ShaftReader::refuse() noexcept {
  counts_ = counts_before_;
  rad_ = shaft_rad(scale_, static_cast<double>(counts_));
  rad_s_ = 0;
  history_ = 0;
}

void ShaftReader::put_at(const DriveFeedback& words) noexcept {
  counts_ += counts_gone(counts_, words.position_counts);
  rad_ = rad_before_ = shaft_rad(scale_, static_cast<double>(counts_));
  rad_s_ = 0;
  history_ = 1;
}

double ShaftReader::rad_at(std::int32_t position_counts) const noexcept {
  return shaft_rad(scale_, static_cast<double>(counts_ + counts_gone(counts_, position_counts)));
}

void ShaftReader::forget() noexcept {
  seen_ = false;
  history_ = 0;
}

void ShaftReader::take_over(std::int64_t counts, bool seen) noexcept {
  seen_ = seen;
  history_ = seen ? 1 : 0;
  counts_ = counts_before_ = counts;
  rad_ = shaft_rad(scale_, static_cast<double>(counts));
}

}  // namespace rmac
