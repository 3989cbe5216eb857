#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// The stretch next to a point of rest, travelled at constant jerk: q ~ s^(4/3) there, which no spline follows
/// (docs/derivations/time-law.md, eq. 12).
struct RestEnd {
  double s_rest = 0;
  int direction = 1;  ///< 1: leaves rest, -1: comes to it
  double length = 0, time = 0, speed = 0, acceleration = 0, jerk = 0;

  /// The state where it meets the rest of the law.
  [[nodiscard]] PathState inner() const noexcept {
    return {s_rest + direction * length, speed, direction * acceleration};
  }
  /// Its law, beginning at time 0.
  [[nodiscard]] LawPiece piece() const noexcept {
    return {0, direction > 0 ? PathState{s_rest, 0, 0} : inner(), jerk, time, LawPiece::Kind::Jerk};
  }
};

/// The stretch that leaves `s_rest` (direction 1) or comes to it (-1): on one segment, at most `longest`
/// long. Nothing where the limits leave none.
[[nodiscard]] std::optional<RestEnd> rest_end(const PathView& path, const std::vector<JointLimits>& joints,
                                              double s_rest, int direction, double longest, const FeedRule& feed);

}  // namespace rmac
