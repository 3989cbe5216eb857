#pragma once

#include <memory>
#include <optional>

#include "bspline.hpp"
#include "build.hpp"
#include "length_table.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::curves {

/// A B-spline in the coordinates of its space, by parameter: the tool axis held or normalised, and which coordinates
/// measure the arc length. Immutable, shared by the curves that one NURBS is cut into.
class SpaceCurve {
 public:
  SpaceCurve(const Nurbs& nurbs, NurbsSpace space, const Vector& held_axis);

  [[nodiscard]] const BSpline& spline() const noexcept { return spline_; }
  [[nodiscard]] NurbsSpace space() const noexcept { return space_; }
  [[nodiscard]] std::size_t dimension() const noexcept { return space_ == NurbsSpace::Joint ? spline_.dimension() : 6; }
  /// Nothing moves: no control point is further than `kZeroLength_mm` from the first.
  [[nodiscard]] bool rests() const noexcept { return rests_; }

  /// Derivatives by parameter. Real-time safe.
  void evaluate(std::size_t span, double t, int order, CurvePoint& point) const noexcept;
  /// Length of the first derivative, in the unit of s. Real-time safe.
  [[nodiscard]] double speed(std::size_t span, double t) const noexcept;
  /// Turns derivatives by parameter into derivatives by arc length (docs/derivations/curves.md, eq. 1). Real-time safe.
  void to_arc_length(int order, CurvePoint& point) const noexcept;
  /// Unit tangent (and rate of the axis) at a place.
  void tangent(std::size_t span, double t, CurvePoint& point) const noexcept;
  /// What speed counts as standing still in a span.
  [[nodiscard]] double least_speed(std::size_t span) const noexcept;
  /// The span is a straight line, however its parameter runs along it: its control points lie on one, in order, and the
  /// tool axis stays.
  [[nodiscard]] bool straight(std::size_t span) const;
  /// All control points of the span are the same, so that nothing moves on it.
  [[nodiscard]] bool stays(std::size_t span) const;
  /// A place where the axis of a pose curve shrinks to nothing, and so has no direction.
  [[nodiscard]] std::optional<LengthTable::Place> vanishing_axis() const;

 private:
  [[nodiscard]] double speed(const CurvePoint& point) const noexcept;
  [[nodiscard]] double product(const CurvePoint& point, std::size_t a, std::size_t b) const noexcept;
  [[nodiscard]] bool axis_vanishes(std::size_t span, double from, double to, int depth,
                                   LengthTable::Place& place) const;

  BSpline spline_;
  NurbsSpace space_;
  Vector held_axis_;
  std::size_t first_ = 0;  ///< coordinates [first_, last_) measure arc length
  std::size_t last_ = 3;
  double unit_ = 1;    ///< units of s per unit of those coordinates
  double extent_ = 0;  ///< of the coordinates that measure length; once, because a curve may have many spans
  bool rests_ = false;
};

/// Spans [first, last) of a space curve, by arc length.
class NurbsCurve final : public Curve {
 public:
  [[nodiscard]] static tl::expected<CurvePtr, LengthTable::Flaw> make(std::shared_ptr<const SpaceCurve> curve,
                                                                      std::size_t first, std::size_t last);

  [[nodiscard]] bool in_joint_space() const noexcept override { return curve_->space() == NurbsSpace::Joint; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return curve_->dimension(); }
  [[nodiscard]] double length() const noexcept override { return table_.length(); }
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return breaks_; }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return nodes_; }
  void evaluate(double s, int order, int side, CurvePoint& point) const noexcept override;

 private:
  explicit NurbsCurve(std::shared_ptr<const SpaceCurve> curve) : curve_(std::move(curve)) {}

  std::shared_ptr<const SpaceCurve> curve_;
  LengthTable table_;
  std::vector<double> breaks_;
  std::vector<double> nodes_;
};

}  // namespace rmac::curves
