#include "curves/bspline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rmac::curves {
namespace {

/// With the first knot and the last as often as a clamped curve has them, and points in a cube of 100.
Nurbs random_nurbs(std::mt19937& random, int degree, bool rational) {
  std::uniform_real_distribution<double> part(0, 1);
  Nurbs nurbs;
  nurbs.degree = degree;
  nurbs.dimension = 1 + random() % 6;
  const std::size_t order = static_cast<std::size_t>(degree) + 1, count = order + random() % 10;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> point;
    for (std::size_t c = 0; c < nurbs.dimension; ++c) point.push_back(100 * part(random));
    nurbs.points.push_back(point);
    if (rational) nurbs.weights.push_back(0.5 + part(random));
  }
  nurbs.knots.assign(order, 0.0);
  for (std::size_t i = order; i < count; ++i) nurbs.knots.push_back(nurbs.knots.back() + 0.1 + part(random));
  nurbs.knots.insert(nurbs.knots.end(), order, nurbs.knots.back() + 1);
  return nurbs;
}

TEST(BSpline, HasTheSameFirstDerivativeAloneAndWithOthers) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> part(0, 1);
  for (int degree = 1; degree <= 12; ++degree) {
    for (int i = 0; i < 40; ++i) {
      const BSpline spline(random_nurbs(random, degree, i % 2 == 0));
      const std::size_t span = random() % spline.span_count();
      const double t = part(random) * spline.span_width(span);
      CurvePoint all, alone;
      spline.evaluate(span, t, 3, all);
      spline.differentiate(span, t, alone);
      double size = 1;
      for (std::size_t c = 0; c < spline.dimension(); ++c) size = std::max(size, std::abs(all.d[1][c]));
      for (std::size_t c = 0; c < spline.dimension(); ++c)
        EXPECT_NEAR(alone.d[1][c], all.d[1][c], 1e-13 * size) << "degree " << degree << " case " << i;
    }
  }
}

}  // namespace
}  // namespace rmac::curves
