#pragma once

#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Both ask for the same and are seen through the same frames, so that one curve can stand for both.
[[nodiscard]] inline bool alike(const PathSegment& a, const PathSegment& b) noexcept {
  const PathDemand &x = a.demand(), &y = b.demand();
  return x.feed_mm_s == y.feed_mm_s && x.accel_rise_mm_s2 == y.accel_rise_mm_s2 &&
         x.accel_fall_mm_s2 == y.accel_fall_mm_s2 && x.tolerance_mm == y.tolerance_mm &&
         x.tolerance_rad == y.tolerance_rad && a.map() == b.map();
}

}  // namespace rmac
