#pragma once

#include <array>
#include <cstddef>

#include "joins/corner_shape.hpp"
#include "rmac/motion/curve.hpp"
#include "rmac/motion/nurbs.hpp"

namespace rmac {

/// A C2 cubic spline on u in [-1, 1] in the six coordinates of a pose, which meets two curves with
/// tangent and curvature (docs/derivations/joins.md, section 1). Its knots and what they leave free follow a shape.
class BlendSpline {
 public:
  static constexpr std::size_t kCoordinates = 6;
  using Values = std::array<double, kCoordinates>;

  /// `before` and `after` hold the curves' derivatives by path length where the blend leaves them, `reach` from where
  /// they meet.
  BlendSpline(const CurvePoint& before, const CurvePoint& after, double reach, const CornerShape& shape);

  [[nodiscard]] Values at(double u) const noexcept;
  /// Largest length of the second derivative over coordinates [first, last).
  [[nodiscard]] double largest_second(std::size_t first, std::size_t last) const noexcept;
  /// The same spline as data: 3 coordinates, or 6 with the tool axis (to be normalised).
  [[nodiscard]] Nurbs nurbs(std::size_t dimension) const;

 private:
  static constexpr std::size_t kMostIntervals = 5;

  void lay_knots(const CornerShape& shape);
  void solve_free(bool lobed);
  void fill_pieces();

  std::size_t intervals_ = 0;
  std::array<double, kMostIntervals + 1> knots_{};
  std::array<Values, kMostIntervals + 3> points_{};
  /// Third derivative on interval i: sum over k of third_[i][k] · points_[k].
  std::array<std::array<double, kMostIntervals + 3>, kMostIntervals> third_{};
  /// Value and derivatives at the left end of each interval, and at u = 1.
  std::array<std::array<Values, 4>, kMostIntervals + 1> pieces_{};
};

}  // namespace rmac
