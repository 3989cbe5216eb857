#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rmac {

/// The cycles that so long a time takes, begun ones too; `least` of them where it is shorter than they are.
[[nodiscard]] inline std::int64_t cycles_of(double seconds, double period_s, std::int64_t least = 1) noexcept {
  return std::max(least, static_cast<std::int64_t>(std::ceil(seconds / period_s - 1e-9)));
}

}  // namespace rmac
