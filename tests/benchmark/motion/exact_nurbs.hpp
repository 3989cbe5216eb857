#pragma once

#include <vector>

#include "rmac/motion/nurbs.hpp"

namespace rmac::bench {

using Real = long double;
using RealPoint = std::vector<Real>;

/// A rational B-spline in extended precision by de Boor's algorithm, of which derivatives come from the control points'
/// differences: an evaluator that shares nothing with the planner's.
class ExactNurbs {
 public:
  explicit ExactNurbs(const Nurbs& nurbs);

  [[nodiscard]] Real begin() const { return levels_[0].knots[degree_]; }
  [[nodiscard]] Real end() const { return levels_[0].knots[levels_[0].points.size()]; }
  [[nodiscard]] std::size_t dimension() const { return dimension_; }
  [[nodiscard]] const std::vector<Real>& knots() const { return levels_[0].knots; }

  /// Point and derivatives by parameter up to the second.
  [[nodiscard]] std::vector<RealPoint> at(Real u, std::size_t order) const;
  /// |dC/du| of the first three coordinates (or fewer).
  [[nodiscard]] Real speed(Real u) const;
  /// Arc length between two parameters of the first three coordinates, by Gauss-Legendre between knots.
  [[nodiscard]] Real length(Real from, Real to) const;
  /// Parameter of the point nearest to `point` (its first three coordinates), by Newton's method from `guess`.
  [[nodiscard]] Real nearest(const double* point, Real guess) const;
  /// Distance of the first three coordinates at u from `point`.
  [[nodiscard]] Real distance(const double* point, Real u) const;

 private:
  struct Level {
    std::size_t degree = 0;
    std::vector<Real> knots;
    std::vector<RealPoint> points;  ///< homogeneous: weight last
  };
  [[nodiscard]] static RealPoint de_boor(const Level& level, Real u);
  [[nodiscard]] Real newton(const double* point, Real guess) const;
  [[nodiscard]] Real length_smooth(Real from, Real to) const;

  std::size_t degree_;
  std::size_t dimension_;
  std::vector<Level> levels_;  ///< the curve, its first and its second derivative
};

}  // namespace rmac::bench
