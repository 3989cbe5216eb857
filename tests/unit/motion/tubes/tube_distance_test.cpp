#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "curves/vector.hpp"
#include "seeds.hpp"
#include "splines/quintic.hpp"
#include "tubes/tube_spline.hpp"

namespace rmac {
namespace {

constexpr double kTolerance_mm = 0.002;

class TubeDistance : public testing::TestWithParam<unsigned> {};

/// A spline beside lines along X, and how far it is from them at 200 places of each, by their closed form.
struct Beside {
  std::vector<double> knots;
  std::vector<Vector> points;
  Polyline polyline;
  std::vector<double> sampled;

  explicit Beside(unsigned seed) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<> off(-2.5 * kTolerance_mm, 2.5 * kTolerance_mm), length(0.05, 0.4);
    double at = 0;
    for (int i = 0; i <= 12; ++i, at += length(random)) {
      polyline.places.push_back(at);
      polyline.vertices.push_back({at, 0, 0});
    }
    polyline.off_mm.assign(12, 0);
    knots.assign(quintic::kDegree, 0);
    for (std::size_t k = 0; k < 12; ++k) {
      for (int part = 0; part < 3; ++part)
        knots.push_back(polyline.places[k] + (polyline.places[k + 1] - polyline.places[k]) * part / 3);
    }
    knots.insert(knots.end(), quintic::kDegree + 1, polyline.places.back());
    for (std::size_t i = 0; i + quintic::kDegree + 1 < knots.size(); ++i) {
      double x = 0;  // Greville's places: x is the parameter
      for (std::size_t d = 1; d <= quintic::kDegree; ++d) x += knots[i + d] / quintic::kDegree;
      points.push_back({x, off(random), off(random)});
    }
    for (std::size_t k = 0; k < 12; ++k) {
      double largest = 0;
      for (int i = 0; i <= 200; ++i) {
        const double place =
            std::min(polyline.places[k] + (polyline.places[k + 1] - polyline.places[k]) * i / 200, at * (1 - 1e-12));
        const Vector p = quintic::value(quintic::basis(knots, points.size(), place), points);
        largest = std::max(largest, std::hypot(p[1], p[2]));
      }
      sampled.push_back(largest);
    }
  }
};

// By how much the tube is made narrower depends on it: told the place where it left the tolerance first, a spline far
// outside was tried again as if it had hardly missed.
TEST_P(TubeDistance, SaysHowFarOutASplineIs) {
  const Beside beside(GetParam());
  const auto distances = tube_distances(beside.knots, beside.points, beside.polyline, kTolerance_mm);
  ASSERT_EQ(distances.size(), beside.sampled.size());
  int outside = 0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (beside.sampled[k] <= kTolerance_mm) continue;
    ++outside;
    EXPECT_GE(distances[k], beside.sampled[k] * (1 - 1e-9)) << "line " << k;
    // Those at its ends count for both lines.
    const double before = k > 0 ? beside.sampled[k - 1] : 0, behind = k + 1 < 12 ? beside.sampled[k + 1] : 0;
    EXPECT_LE(distances[k], 1.01 * std::max({beside.sampled[k], before, behind})) << "line " << k;
  }
  EXPECT_GT(outside, 2);
}

TEST_P(TubeDistance, OfASplineWithinIsNoMoreThanTheTolerance) {
  Beside beside(GetParam());
  const double part = 0.999 * kTolerance_mm / *std::max_element(beside.sampled.begin(), beside.sampled.end());
  for (Vector& point : beside.points) point = {point[0], part * point[1], part * point[2]};
  const auto distances = tube_distances(beside.knots, beside.points, beside.polyline, kTolerance_mm);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    EXPECT_LE(distances[k], kTolerance_mm) << "line " << k;
    EXPECT_GE(distances[k], part * beside.sampled[k] * (1 - 1e-9)) << "line " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, TubeDistance, test::seeds(12));

}  // namespace
}  // namespace rmac
