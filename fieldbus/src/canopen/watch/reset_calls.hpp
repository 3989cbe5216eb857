#pragma once

#include <chrono>
#include <utility>

namespace rmac::fieldbus::canopen {

/// When a node that has not sent its boot-up message is reset. Silent, it may be booting, and one that boots may obey
/// resets: after the first it is reset only when it shows that it was not, and less often each time. Real-time safe.
class ResetCalls {
 public:
  using Time = std::chrono::nanoseconds;

  void restart(Time now) noexcept {
    next_ = now;
    pause_ = kFirstPause;
    lives_ = true;  // as far as anybody knows
  }
  /// It spoke, and it was no boot-up message. What was on its way when it was reset is no evidence.
  void heard(Time now) noexcept {
    if (now >= next_) lives_ = true;
  }
  /// True once for each reset that is to be sent.
  [[nodiscard]] bool due(Time now) noexcept {
    if (now < next_ || !std::exchange(lives_, false)) return false;
    next_ = now + pause_;
    pause_ *= 2;
    return true;
  }
  /// It may be asked whether it is there.
  [[nodiscard]] bool asks(Time now) const noexcept { return now >= next_; }

 private:
  static constexpr std::chrono::seconds kFirstPause{1};

  Time next_{0}, pause_{kFirstPause};
  bool lives_ = false;
};

}  // namespace rmac::fieldbus::canopen
