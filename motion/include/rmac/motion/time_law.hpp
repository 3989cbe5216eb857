#pragma once

#include <cstdint>
#include <vector>

namespace rmac {

/// Motion along the path at one instant: path length, speed, acceleration (mm, mm/s, mm/s²).
struct PathState {
  double s = 0;
  double v = 0;
  double a = 0;
};

/// A stretch of time law. `Linear`: the acceleration is a linear function of the path length, a = a0 + slope·(s - s0),
/// so v² is quadratic in s (docs/derivations/time-law.md, eq. 4). `Jerk`: constant jerk `slope` in time; used where the
/// speed is zero at one end.
struct LawPiece {
  enum class Kind : std::uint8_t { Linear, Jerk };
  double t0 = 0;  ///< s since the start of the plan
  PathState start;
  double slope = 0;
  double duration = 0;
  Kind kind = Kind::Jerk;

  /// State `t` seconds after the piece began. Real-time safe.
  [[nodiscard]] PathState at(double t) const noexcept;
};

}  // namespace rmac
