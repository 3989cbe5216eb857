#include "short_lines/dense_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "unit/motion/joins/traces.hpp"

namespace rmac::test {
namespace {

constexpr double kRadius_mm = 10;

/// A circle of chords, which may be rounded.
Polyline circle(double line_mm, double rounding_mm) {
  Polyline polyline;
  const int lines = static_cast<int>(std::round(24 / line_mm));
  for (int i = 0; i <= lines; ++i) {
    const double angle = line_mm * i / kRadius_mm;
    Vector here{kRadius_mm * std::sin(angle), kRadius_mm * (1 - std::cos(angle)), 0};
    if (rounding_mm > 0)
      for (double& c : here) c = std::round(c / rounding_mm) * rounding_mm;
    if (i == 0) {
      polyline = {{here}, {0}, {}, {}};
    } else {
      polyline.add(here, distance(polyline.vertices.back(), here));
    }
  }
  return polyline;
}

struct Rounded {
  double line_mm, rounding_mm, tolerance_mm;
};

class DenseSpline : public ::testing::TestWithParam<Rounded> {};

TEST_P(DenseSpline, BendsAsTheCircleThatTheRoundedLinesCameFrom) {
  const auto& [line_mm, rounding_mm, tolerance_mm] = GetParam();
  const Polyline polyline = circle(line_mm, rounding_mm);
  const auto spline = smoothest_along({polyline, tolerance_mm, tolerance_mm, 8}, {});
  ASSERT_TRUE(spline);
  const auto of_order = [&](double place, std::size_t order) {
    return quintic::value(quintic::derivatives(spline->knots, spline->points.size(), place, order), spline->points);
  };
  for (double place = 4; place <= 20; place += 0.03) {
    // Rounding alone bends a line of 0.02 mm by a radius of 0.4 mm.
    EXPECT_NEAR(distance(of_order(place, 2), {}), 1 / kRadius_mm, 0.02 / kRadius_mm) << place;
    EXPECT_NEAR(distance(of_order(place, 3), {}), 1 / kRadius_mm / kRadius_mm, 0.15 / kRadius_mm / kRadius_mm) << place;
  }
}

TEST_P(DenseSpline, IsWithinWhatItSaysOfEachLineAndThatWithinTheTolerance) {
  const auto& [line_mm, rounding_mm, tolerance_mm] = GetParam();
  const Polyline polyline = circle(line_mm, rounding_mm);
  const auto spline = smoothest_along({polyline, tolerance_mm, tolerance_mm, 8}, {});
  ASSERT_TRUE(spline);
  ASSERT_EQ(spline->deviations.size(), polyline.lines());
  for (std::size_t k = 0; k < polyline.lines(); ++k) {
    EXPECT_LE(spline->deviations[k], tolerance_mm);
    for (double part = 0; part <= 1; part += 0.125) {
      const double place = polyline.places[k] + part * (polyline.places[k + 1] - polyline.places[k]);
      const Vector here = quintic::value(quintic::basis(spline->knots, spline->points.size(), place), spline->points);
      EXPECT_LE(distance_to_chord(here, polyline.vertices[k], polyline.vertices[k + 1]), spline->deviations[k] + 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Roundings, DenseSpline,
                         ::testing::Values(Rounded{0.02, 0.001, 0.01}, Rounded{0.05, 0.001, 0.01},
                                           Rounded{0.1, 0.001, 0.003}, Rounded{0.1, 0.001, 0.05},
                                           Rounded{0.1, 0.01, 0.02}, Rounded{0.5, 0.001, 0.01}, Rounded{0.5, 0, 0.01}));

TEST(DenseSplines, LeaveHalfOfTheToleranceBesideACorner) {
  const Polyline polyline = circle(0.1, 0.01);
  DenseLines lines{polyline, 0.02, 0.02, 8, 2, 3};
  const auto spline = smoothest_along(lines, {});
  ASSERT_TRUE(spline);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_LE(spline->deviations[k], 0.01);
  for (std::size_t k = polyline.lines() - 29; k < polyline.lines(); ++k) EXPECT_LE(spline->deviations[k], 0.01);
}

TEST(DenseSplines, AreNoneOfCornersThatTheToleranceCannotPass) {
  Polyline zigzag{{{0, 0, 0}}, {0}, {}, {}};
  for (int i = 1; i <= 60; ++i) zigzag.add({0.3 * i, i % 2 == 0 ? 0 : 0.2, 0}, std::hypot(0.3, 0.2));
  EXPECT_FALSE(smoothest_along({zigzag, 0.001, 0.001, 6}, {}));
}

}  // namespace
}  // namespace rmac::test
