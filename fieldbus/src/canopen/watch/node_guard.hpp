#pragma once

#include <algorithm>
#include <chrono>

#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::fieldbus::canopen {

/// Node guarding (CiA 301, 7.2.8.3.2.1), for nodes that make no heartbeat: they are asked for their state, and know by
/// that that their master lives. An answer whose toggle bit is that of the one before is a copy, or another device's,
/// and no sign of life. Real-time safe.
class NodeGuard {
 public:
  using Time = std::chrono::nanoseconds;

  explicit NodeGuard(Time period) noexcept : period_(period) {}

  /// The node was reset: its first answer has a toggle bit of 0.
  void restart(Time now) noexcept {
    next_ = now;
    toggle_ = false;
  }
  /// True once for each question that is due.
  [[nodiscard]] bool asks(Time now) noexcept {
    if (now < next_) return false;
    next_ = std::max(next_ + period_, now);
    return true;
  }
  /// Whether an answer is a sign of life.
  [[nodiscard]] bool take(const CanFrame& answer) noexcept {
    constexpr std::uint8_t kToggle = 0x80;
    if (((answer.data[0] & kToggle) != 0) != toggle_) return false;
    toggle_ = !toggle_;
    return true;
  }

 private:
  Time period_;
  Time next_{0};
  bool toggle_ = false;  ///< of the next answer
};

}  // namespace rmac::fieldbus::canopen
