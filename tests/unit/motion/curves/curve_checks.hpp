#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "curves/make_curves.hpp"

namespace rmac::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Curves = std::vector<std::unique_ptr<const Curve>>;

inline CurveStart at(const Vector& tip, const Vector& axis = {0, 0, 1}) {
  return {{tip, axis}, {}};
}

inline Move move_of(Geometry geometry) {
  Move move;
  move.id = 1;
  move.geometry = std::move(geometry);
  return move;
}

inline Curves built(const Geometry& geometry, const CurveStart& start) {
  auto curves = make_curves(move_of(geometry), start);
  if (!curves) {
    ADD_FAILURE() << curves.error().message;
    return {};
  }
  return std::move(*curves);
}

/// The message with which a geometry is refused; empty where it is not.
inline std::string refusal(const Geometry& geometry, const CurveStart& start) {
  const auto curves = make_curves(move_of(geometry), start);
  return curves ? std::string() : curves.error().message;
}

inline double size_of(const CurvePoint& point, std::size_t order, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t c = first; c < last; ++c) sum += point.d[order][c] * point.d[order][c];
  return std::sqrt(sum);
}

/// Each derivative equals the derivative of the one below it, by central differences of eighth order that stay inside
/// the smooth stretch [from, to]. Errors are relative to the size of the derivative and to 1 / step.
inline void expect_derivatives(const Curve& curve, double s, double from, double to, double tolerance) {
  static constexpr double kWeights[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  // Short enough that a knot that jumps in the fourth derivative only, which is no break, does no harm.
  const double step = std::min(std::min(s - from, to - s) / 40, 2e-3);
  CurvePoint here;
  curve.evaluate(s, 3, 1, here);
  for (std::size_t order = 1; order <= 3; ++order) {
    double size = 0;
    for (std::size_t c = 0; c < curve.dimension(); ++c) size = std::max(size, std::abs(here.d[order][c]));
    for (std::size_t c = 0; c < curve.dimension(); ++c) {
      double slope = 0;
      double noise = 0;
      for (int i = 1; i <= 4; ++i) {
        CurvePoint ahead;
        CurvePoint behind;
        curve.evaluate(s + i * step, static_cast<int>(order) - 1, 1, ahead);
        curve.evaluate(s - i * step, static_cast<int>(order) - 1, 1, behind);
        slope += kWeights[i - 1] * (ahead.d[order - 1][c] - behind.d[order - 1][c]) / step;
        noise = std::max(noise, std::abs(ahead.d[order - 1][c]));
      }
      EXPECT_NEAR(here.d[order][c], slope, tolerance * size + 1e-13 * noise / step + 1e-12)
          << "derivative " << order << " of coordinate " << c << " at s = " << s;
    }
  }
}

/// The properties that every curve promises, over its whole length.
inline void expect_sound(const Curve& curve, double tolerance) {
  ASSERT_GT(curve.length(), 0);
  std::vector<double> borders{0};
  borders.insert(borders.end(), curve.breaks().begin(), curve.breaks().end());
  borders.push_back(curve.length());
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    ASSERT_LT(borders[i], borders[i + 1]) << "breaks ascend inside the curve";
    const double width = borders[i + 1] - borders[i];
    for (const double f : {0.11, 0.5, 0.83}) {
      expect_derivatives(curve, borders[i] + f * width, borders[i], borders[i + 1], tolerance);
    }
  }
  for (const double s : curve.breaks()) {
    CurvePoint before;
    CurvePoint after;
    curve.evaluate(s, 1, -1, before);
    curve.evaluate(s, 1, 1, after);
    for (std::size_t c = 0; c < curve.dimension(); ++c) {
      EXPECT_NEAR(before.d[0][c], after.d[0][c], 1e-11) << "position at the break " << s;
      EXPECT_NEAR(before.d[1][c], after.d[1][c], 2e-7 * std::max(1.0, size_of(before, 1, 0, curve.dimension())))
          << "tangent at the break " << s;
    }
  }
  const auto nodes = curve.nodes();
  ASSERT_GE(nodes.size(), 2U);
  EXPECT_EQ(nodes.front(), 0);
  EXPECT_EQ(nodes.back(), curve.length());
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) ASSERT_LT(nodes[i], nodes[i + 1]);
  for (const double s : curve.breaks()) {
    EXPECT_TRUE(std::binary_search(nodes.begin(), nodes.end(), s)) << "no node at the break " << s;
  }
}

}  // namespace rmac::test
