#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace rmac {

/// By how many cycles answers may be further apart than they should: drives go on while the appliance is late, and
/// what they did meanwhile is told as many cycles later as their answers are old. Real-time safe.
class LateAnswers {
 public:
  /// `delays`: of all drives, in cycles.
  explicit LateAnswers(std::span<const std::uint8_t> delays) noexcept {
    for (const std::uint8_t delay : delays) longest_ = std::max<int>(longest_, delay);
  }

  /// One cycle, and those that were missed before it.
  void step(std::uint64_t missed) noexcept {
    left_ = std::max(0, left_ - 1);
    if (missed > 0) {
      missed_ = std::max(missed, left_ > 0 ? missed_ : 0);
      left_ = longest_ + 1;
    }
  }
  [[nodiscard]] std::uint64_t now() const noexcept { return left_ > 0 ? missed_ : 0; }

 private:
  int longest_ = 0;
  int left_ = 0;  ///< cycles
  std::uint64_t missed_ = 0;
};

}  // namespace rmac
