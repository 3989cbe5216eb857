#pragma once

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "unit/motion/curves/curve_checks.hpp"

namespace rmac::test {

/// Seeded poses, and what curves that begin and end at such are to keep.
class Shapes : public testing::Test {
 protected:
  double number() { return range_(random_); }
  Vector vector() { return {100 * number(), 100 * number(), 100 * number()}; }
  Vector axis() {
    const double lean = 0.8 * number();
    const double about = std::numbers::pi * number();
    return {std::sin(lean) * std::cos(about), std::sin(lean) * std::sin(about), std::cos(lean)};
  }
  ToolPose pose() { return {vector(), axis()}; }

  static void expect_ends(const Curve& curve, const ToolPose& start, const ToolPose& end) {
    CurvePoint a;
    CurvePoint b;
    curve.evaluate(0, 0, 1, a);
    curve.evaluate(curve.length(), 0, -1, b);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(a.d[0][c], start.tip[c], 1e-12);
      EXPECT_NEAR(b.d[0][c], end.tip[c], 1e-10);
      EXPECT_NEAR(a.d[0][c + 3], start.axis[c], 1e-14);
      EXPECT_NEAR(b.d[0][c + 3], end.axis[c], 1e-13);
    }
  }

  /// Tip at unit speed, axis unit and turning at a steady rate.
  static void expect_steady(const Curve& curve) {
    CurvePoint point;
    curve.evaluate(0, 1, 1, point);
    const double rate = size_of(point, 1, 3, 6);
    for (int i = 0; i <= 20; ++i) {
      curve.evaluate(curve.length() * i / 20, 1, 1, point);
      EXPECT_NEAR(size_of(point, 1, 0, 3), 1, 1e-13);
      EXPECT_NEAR(size_of(point, 0, 3, 6), 1, 1e-14);
      EXPECT_NEAR(size_of(point, 1, 3, 6), rate, 1e-13);
    }
  }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> range_{-1, 1};
};

}  // namespace rmac::test
