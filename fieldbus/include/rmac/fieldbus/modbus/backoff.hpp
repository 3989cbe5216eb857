#pragma once

#include <algorithm>
#include <chrono>

namespace rmac::fieldbus::modbus {

/// When to try again what failed: at once the first time, then after pauses that double from `shortest` to `longest`.
class Backoff {
 public:
  using Clock = std::chrono::steady_clock;

  Backoff(Clock::duration shortest, Clock::duration longest) noexcept
      : shortest_(shortest), longest_(longest), pause_(shortest) {}

  [[nodiscard]] bool due(Clock::time_point now) const noexcept { return now >= next_; }
  [[nodiscard]] Clock::time_point next() const noexcept { return next_; }

  void failed(Clock::time_point now) noexcept {
    next_ = now + pause_;
    pause_ = std::min(pause_ * 2, longest_);
  }
  void succeeded() noexcept {
    next_ = {};
    pause_ = shortest_;
  }

 private:
  Clock::duration shortest_, longest_, pause_;
  Clock::time_point next_{};
};

}  // namespace rmac::fieldbus::modbus
