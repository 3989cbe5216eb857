#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace rmac {

/// From one velocity and acceleration to another, in units in which the largest jerk is 1; the distance is the caller's
/// matter. All bounds are magnitudes.
struct Transfer {
  double v0, a0, v1, a1;
  double v_top, v_bottom;
  double a_top, a_bottom;

  /// Up becomes down.
  [[nodiscard]] Transfer mirrored() const noexcept { return {-v0, -a0, -v1, -a1, v_bottom, v_top, a_bottom, a_top}; }
  /// From the end to the begin, with the same distance (eq. 3).
  [[nodiscard]] Transfer reversed() const noexcept { return {v1, -a1, v0, -a0, v_top, v_bottom, a_bottom, a_top}; }
};

/// Constant jerks, one after the other.
struct Phases {
  struct Phase {
    double duration, jerk;
  };
  std::array<Phase, 16> phase;
  std::size_t count = 0;

  void add(double duration, double jerk) noexcept {
    if (duration > 0) phase[count++] = {duration, jerk};
  }
  void mirror() noexcept;
  void reverse() noexcept;
};

/// Of what rounding may leave below zero.
[[nodiscard]] inline double root(double square) noexcept {
  return std::sqrt(std::max(square, 0.0));
}

/// Velocity that the acceleration's fall to zero leads to (eq. 2).
[[nodiscard]] inline double settled_velocity(double v, double a) noexcept {
  return v + 0.5 * a * (a < 0 ? -a : a);
}

/// Brings v and a inside of the transfer's bounds, as fast as they allow (section 2): phases, and what v, a become.
[[nodiscard]] Phases bring_inside(double& v, double& a, const Transfer& bounds) noexcept;

/// The fastest phases from (v0, a0) to (v1, a1) (eq. 4, 5).
[[nodiscard]] Phases fastest_change(const Transfer& transfer) noexcept;

/// Durations in which (v1, a1) can be reached from (v0, a0) at all: all from `shortest` on, without those between
/// gap_begin and gap_end (eq. 6).
struct Durations {
  double shortest = 0;
  double gap_begin = 0, gap_end = 0;  ///< equal: no gap

  explicit Durations(const Transfer& transfer) noexcept;
  [[nodiscard]] bool gap() const noexcept { return gap_end > gap_begin; }
};

}  // namespace rmac
