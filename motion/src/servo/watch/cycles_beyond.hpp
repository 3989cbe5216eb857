#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rmac {

/// Tells a value that stays beyond its bound. One word that came late makes one step of a position too short and the
/// next one too long; three do not.
class CyclesBeyond {
 public:
  static constexpr int kMost = 3;

  /// One cycle. True from the third cycle on end in which `value` is beyond `bound`, either way; a bound of 0 is none.
  [[nodiscard]] bool step(double value, double bound) noexcept {
    cycles_ = bound > 0 && std::abs(value) > bound ? std::min(cycles_ + 1, kMost) : 0;
    return cycles_ == kMost;
  }
  void restart() noexcept { cycles_ = 0; }

 private:
  int cycles_ = 0;
};

}  // namespace rmac
