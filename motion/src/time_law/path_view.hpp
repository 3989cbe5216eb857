#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// A place just inside an interval of the path from one of its ends. Path lengths are sums, so a place meant to be a
/// knot's misses it by rounding, and a derivative that jumps there would be taken from the other side.
[[nodiscard]] inline double just_inside(double end, double other_end) noexcept {
  const double h = other_end - end;
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(end);
  return end + std::copysign(std::min(std::max(1e-7 * std::abs(h), rounding), std::abs(h) / 4), h);
}

/// Segments laid end to end on one path length. Read only; whoever owns the vectors keeps them alive.
class PathView {
 public:
  PathView(const PathSegments& segments, const std::vector<double>& starts) : segments_(segments), starts_(starts) {}

  /// Index of the segment that holds s; at a boundary the one before (side -1) or after (+1).
  [[nodiscard]] std::size_t find(double s, int side) const noexcept {
    const auto it = side < 0 ? std::lower_bound(starts_.begin(), starts_.end(), s)
                             : std::upper_bound(starts_.begin(), starts_.end(), s);
    return it == starts_.begin() ? 0 : static_cast<std::size_t>(it - starts_.begin()) - 1;
  }
  [[nodiscard]] KinematicsStatus evaluate(double s, int order, int side, JointPoint& point) const noexcept {
    const std::size_t i = find(s, side);
    return segments_[i]->evaluate(std::clamp(s - starts_[i], 0.0, segments_[i]->length()), order, side, point);
  }
  /// The joints' derivatives by path length, to the third: d[0] may be left as it was.
  [[nodiscard]] KinematicsStatus derivatives(double s, int side, JointPoint& point) const noexcept {
    const std::size_t i = find(s, side);
    return segments_[i]->derivatives(std::clamp(s - starts_[i], 0.0, segments_[i]->length()), side, point);
  }
  [[nodiscard]] const PathSegment& segment(std::size_t i) const noexcept { return *segments_[i]; }
  [[nodiscard]] double start(std::size_t i) const noexcept { return starts_[i]; }
  [[nodiscard]] double end() const noexcept { return starts_.back() + segments_.back()->length(); }

 private:
  const PathSegments& segments_;
  const std::vector<double>& starts_;
};

}  // namespace rmac
