#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// A point of a curve with derivatives by its own arc length: `d[k][c]` is the k-th derivative of coordinate c.
struct CurvePoint {
  std::array<std::array<double, kMaxJoints>, 4> d;
};

/// A curve parametrised by arc length s in [0, length()]. In pose space the coordinates are tip x y z (mm, part frame)
/// and unit tool axis i j k, and s is the length of the tip's path (of the axis' turn in degrees where the tip rests);
/// in joint space they are the joints and s is the Euclidean length in joint units. A curve in pose space may add the
/// rotary joints, in their order, as coordinates 6 on: then they are what turns, and i j k only tells where to, without
/// derivatives. Smooth inside; second and third derivatives may jump at `breaks()` only, never the first. Immutable;
/// safe from every thread; `evaluate` is real-time safe.
class Curve {
 public:
  virtual ~Curve() = default;
  [[nodiscard]] virtual bool in_joint_space() const noexcept = 0;
  [[nodiscard]] virtual std::size_t dimension() const noexcept = 0;
  [[nodiscard]] virtual double length() const noexcept = 0;
  /// The tip moves on a straight line and the tool axis stays.
  [[nodiscard]] virtual bool straight() const noexcept { return false; }
  /// The tip moves on a straight line, and the tool axis stays or turns on a great circle in step with it, or was
  /// programmed to.
  [[nodiscard]] virtual bool even() const noexcept { return straight(); }
  /// What was asked for, where this curve may leave it: past the pole.
  [[nodiscard]] virtual const Curve& programmed() const noexcept { return *this; }
  /// Derivatives up to `order` (0 to 3). At a break (met to a few ulps)
  /// `side` chooses the limit from below (-1) or above (+1).
  virtual void evaluate(double s, int order, int side, CurvePoint& point) const noexcept = 0;
  /// Ascending arc lengths inside (0, length()) where the second or third derivative may jump.
  [[nodiscard]] virtual std::span<const double> breaks() const noexcept = 0;
  /// Ascending arc lengths from 0 to length(), spaced so that between neighbours curvature and its change are small:
  /// what a planner's grid must at least contain.
  [[nodiscard]] virtual std::span<const double> nodes() const noexcept = 0;
};

}  // namespace rmac
