#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "lanes.hpp"
#include "rmac/motion/curve.hpp"
#include "rmac/motion/nurbs.hpp"

namespace rmac::curves {

inline constexpr std::size_t kMaxDegree = 25;

/// A checked NURBS ready for evaluation: derivatives up to the third by the curve's parameter (The NURBS Book, A2.2,
/// A3.3 and A4.2; docs/derivations/curves.md, section 3). Places are a span (a knot interval that is not empty, counted
/// from 0) and t, the distance from the span's first knot with the whole domain scaled to length 1: short spans far
/// from the first knot keep all their digits. Up to degree 7 each span is kept as a polynomial about its middle, which
/// spares the B-spline's recursion with its divisions. Immutable; `evaluate` is real-time safe.
class BSpline {
 public:
  /// `nurbs` must have passed `check_nurbs`.
  explicit BSpline(const Nurbs& nurbs);

  [[nodiscard]] std::size_t degree() const noexcept { return degree_; }
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }
  [[nodiscard]] std::size_t span_count() const noexcept { return spans_.size(); }
  /// Largest t of a span.
  [[nodiscard]] double span_width(std::size_t span) const noexcept {
    return knots_[spans_[span] + 1] - knots_[spans_[span]];
  }
  /// How often the knot at the span's start occurs.
  [[nodiscard]] std::size_t multiplicity(std::size_t span) const noexcept;
  /// The client's parameter of a place, for messages.
  [[nodiscard]] double parameter(std::size_t span, double t) const noexcept {
    return first_ + range_ * (knots_[spans_[span]] + t);
  }
  /// Largest distance of a control point from the first, over coordinates [first, last).
  [[nodiscard]] double extent(std::size_t first, std::size_t last) const noexcept;

  /// Control point `i` of the degree + 1 that shape a span, over coordinates [first, last).
  [[nodiscard]] std::vector<double> control_point(std::size_t span, std::size_t i, std::size_t first,
                                                  std::size_t last) const;

  void evaluate(std::size_t span, double t, int order, CurvePoint& point) const noexcept;
  /// The first derivative alone, d[1].
  void differentiate(std::size_t span, double t, CurvePoint& point) const noexcept;

 private:
  /// Above this degree powers of the parameter lose digits that the basis functions keep.
  static constexpr std::size_t kPowerDegree = 7;

  using Homogeneous = std::array<double, kMaxJoints + kLanes>;  ///< a stored point, and room for whole lanes
  void make_derivatives();
  void make_powers();
  /// Derivatives of orders 0 to sums.size() - 1, at most the degree.
  void basis_sums(std::size_t span, double t, std::span<Homogeneous> sums) const noexcept;
  /// Orders 0 to kOrder; rows of whole lanes, which may be more numbers than a point has coordinates.
  template <std::size_t kOrder, typename Row>
  void power_sums(std::size_t span, double t, std::array<Row, 4>& sums) const noexcept;

  std::size_t degree_;
  std::size_t dimension_;
  std::size_t width_;  ///< coordinates a stored point: one more than the dimension where there are weights
  bool rational_;
  double first_ = 0;
  double range_ = 1;
  std::vector<double> knots_;
  std::vector<std::size_t> spans_;           ///< index of each span's first knot
  std::array<double, kMaxJoints> origin_{};  ///< subtracted from all points: weights far from it would lose digits
  std::vector<std::vector<double>> points_;  ///< control points of the curve and its derivatives
  std::vector<double> powers_;               ///< degree + 1 rows of whole lanes a span; empty for higher degrees
  std::vector<double> power_rates_;          ///< of a span: du/dt of the powers' u
};

}  // namespace rmac::curves
