#pragma once

#include "build.hpp"

namespace rmac::curves {

/// The tool axis on the great circle from one direction to another, in step with the arc length
/// (docs/derivations/curves.md, eq. 2).
class AxisTurn {
 public:
  /// Both axes unit. Refuses opposite axes: every great circle joins them.
  [[nodiscard]] static Expected<AxisTurn> between(const Vector& from, const Vector& to);

  [[nodiscard]] double angle_rad() const noexcept { return angle_rad_; }

  /// Axis and derivatives by s into coordinates 3 to 5, where the whole turn takes the arc length `length`.
  void evaluate(double s, double length, int order, CurvePoint& point) const noexcept;

 private:
  Vector from_{0, 0, 1};
  Vector across_{0, 0, 0};  ///< unit, perpendicular to `from_`, in the plane of the turn
  double angle_rad_ = 0;
};

}  // namespace rmac::curves
