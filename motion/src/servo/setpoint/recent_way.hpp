#pragma once

#include <array>
#include <cstdint>
#include <numeric>

#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac {

/// How far something went within its last cycles, so that what is told of it late can be held against where it was
/// then. Real-time safe.
class RecentWay {
 public:
  explicit RecentWay(int cycles = 0) noexcept : cycles_(cycles) {}

  /// A cycle in which it has not gone anywhere so far.
  void begin_cycle() noexcept {
    now_ = now_ + 1 < cycles_ ? now_ + 1 : 0;
    ways_[static_cast<std::size_t>(now_)] = 0;
  }
  /// It went so far in this cycle.
  void went(double way) noexcept {
    if (cycles_ > 0) ways_[static_cast<std::size_t>(now_)] = way;
  }
  /// It was put where it is.
  void forget() noexcept { ways_.fill(0); }
  [[nodiscard]] double length() const noexcept { return std::accumulate(ways_.begin(), ways_.begin() + cycles_, 0.0); }

 private:
  int cycles_;
  int now_ = 0;
  std::array<double, kMostAnswerDelay> ways_{};
};

}  // namespace rmac
