#pragma once

#include <chrono>

namespace rmac::gateway {

/// Whether virtual time keeps to the clock, as it does at rest: whoever serves it has little to do then. Asked again
/// and again. One thread.
class ClockWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Length = std::chrono::duration<double>;

  explicit ClockWatch(Length period) noexcept : period_(period) {}

  /// It is `now`, and the machine's time has come so far. It does no longer keep to the clock as soon as it is found
  /// ahead, or standing still for what others are to do; and keeps to it again after a while of doing so.
  [[nodiscard]] bool keeps(Length machine, Time now) noexcept {
    if (!keeps_ && now - since_ < kWhile) return false;
    const Length elapsed = now - since_, gone = machine - from_;
    if (gone <= Length(0) && elapsed <= 2 * period_) return keeps_;  // no cycle was due
    keeps_ = gone >= elapsed / 2 - period_ && gone <= 2 * elapsed + 2 * period_;
    since_ = now;
    from_ = machine;
    return keeps_;
  }

 private:
  static constexpr std::chrono::milliseconds kWhile{20};

  Length period_;
  Time since_{};
  Length from_{0};
  bool keeps_ = false;
};

}  // namespace rmac::gateway
