#pragma once

#include <algorithm>
#include <cmath>

namespace rmac::legacy {

/// How far above the depth that was reached a peck goes on from rapid to feed: LinuxCNC's 0.010 inch.
inline constexpr double kPeckBackOff_mm = 0.254;
/// Of one hole, and of what repeats it: what asks for more is a slip of units.
inline constexpr int kMostPecks = 10'000;

/// How many pecks of this depth reach the bottom; at most kMostPecks is what is asked for. A last one of less than a
/// thousand-millionth of a peck is none.
[[nodiscard]] inline int pecks_to(double depth_mm, double peck_mm) {
  constexpr double kSameDepth = 1e-9;
  return static_cast<int>(std::max(1.0, std::ceil(depth_mm / peck_mm - kSameDepth)));
}

}  // namespace rmac::legacy
