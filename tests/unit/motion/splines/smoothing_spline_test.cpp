#include "splines/smoothing_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "curves/vector.hpp"

namespace rmac::test {
namespace {

using curves::along;
using curves::difference;
using curves::norm;
using quintic::kDegree;

std::vector<double> knots_to(double end, double step) {
  std::vector<double> knots(kDegree, 0.0);
  const int spans = static_cast<int>(std::round(end / step));
  for (int i = 0; i <= spans; ++i) knots.push_back(end * i / spans);
  knots.insert(knots.end(), kDegree, end);
  return knots;
}

std::vector<SplineSample> samples_to(double end, double spacing, double width_mm,
                                     const std::function<Vector(double)>& shape) {
  std::vector<SplineSample> samples;
  const int count = static_cast<int>(std::round(end / spacing));
  for (int i = 0; i <= count; ++i) {
    const double place = end * i / count;
    SplineSample sample{place, shape(place)};
    sample.share = i == 0 || i == count ? spacing / 2 : spacing;
    sample.width_mm = width_mm;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Vector> solved(const std::vector<double>& knots, std::vector<SplineSample>& samples) {
  std::vector<Vector> points(knots.size() - kDegree - 1);
  points.front() = samples.front().point;
  EXPECT_TRUE(SmoothingSpline(knots, samples).solve(1, points));
  return points;
}

Vector at(const std::vector<double>& knots, const std::vector<Vector>& points, double place) {
  return quintic::value(quintic::basis(knots, points.size(), place), points);
}

TEST(SmoothingSpline, LeavesAParabolaAsItIsWhateverTheWidth) {
  const auto parabola = [](double x) { return Vector{x, 0.1 * x * x - x, 100 + 0.3 * x * x}; };
  for (const double width : {0.05, 0.5, 5.0}) {
    const auto knots = knots_to(20, 0.5);
    auto samples = samples_to(20, 0.1, width, parabola);
    const auto points = solved(knots, samples);
    for (double x = 0; x <= 20; x += 0.07) EXPECT_LT(norm(difference(at(knots, points, x), parabola(x))), 1e-7);
  }
}

TEST(SmoothingSpline, KeepsOfAWaveWhatIsLongerThanItsWidth) {
  for (const double width : {0.3, 0.6, 0.9}) {
    for (const double length : {2.0, 4.0, 8.0}) {
      const double wave = 2 * std::numbers::pi / length;
      const auto knots = knots_to(48, width / 2);
      auto samples = samples_to(48, 0.05, width, [&](double x) { return Vector{x, std::sin(wave * x), 0}; });
      const auto points = solved(knots, samples);
      const double kept = 1 / (1 + std::pow(wave * width, 6));
      // A crest in the middle, far from the ends.
      EXPECT_NEAR(at(knots, points, 24 + length / 4)[1], kept, 0.002) << width << " of " << length;
    }
  }
}

TEST(SmoothingSpline, TellsByHowMuchItMayMissEachStretchAndHardlyMore) {
  std::mt19937 random(7);
  std::uniform_real_distribution<> noise(-0.05, 0.05);
  for (const double width : {0.2, 0.5, 1.0}) {
    const auto knots = knots_to(30, 0.4);
    auto samples = samples_to(30, 0.1, width, [&](double x) {
      const double y = noise(random);
      return Vector{x, std::sin(x / 3) + y, noise(random)};
    });
    const auto points = solved(knots, samples);
    for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
      const Vector chord = difference(samples[k + 1].point, samples[k].point);
      double off = 0;
      for (double part = 0; part <= 1; part += 0.05) {
        const double place = samples[k].place + part * (samples[k + 1].place - samples[k].place);
        off = std::max(off, norm(difference(at(knots, points, place), along(samples[k].point, part, chord))));
      }
      EXPECT_LE(off, samples[k].off + 1e-12);
      EXPECT_LE(samples[k].off, off + 0.01);
    }
  }
}

TEST(SmoothingSpline, LeavesTheControlPointsThatAreGivenAndEndsInTheLastSample) {
  const auto circle = [](double x) { return Vector{10 * std::cos(x / 10), 10 * std::sin(x / 10), 0}; };
  const auto knots = knots_to(12, 0.5);
  auto samples = samples_to(12, 0.1, 0.8, circle);
  auto points = solved(knots, samples);
  for (std::size_t i = 0; i < kDegree; ++i) points[i][2] += 0.001 * static_cast<double>(i);
  const std::vector<Vector> given(points.begin(), points.begin() + kDegree);
  ASSERT_TRUE(SmoothingSpline(knots, samples).solve(kDegree, points));
  EXPECT_TRUE(std::equal(given.begin(), given.end(), points.begin()));
  EXPECT_LT(norm(difference(points.back(), circle(12))), 1e-12);
  EXPECT_LT(norm(difference(at(knots, points, 10), circle(10))), 1e-3) << "the bend at its start is gone by here";
}

}  // namespace
}  // namespace rmac::test
