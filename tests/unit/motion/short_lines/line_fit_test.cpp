#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "seeds.hpp"
#include "unit/motion/joins/traces.hpp"

namespace rmac::test {
namespace {

/// A rose of five leaves from the origin, in lines; `rounding_mm` is what the client's coordinates are rounded to.
Trace rose(double line_mm, double rounding_mm = 0) {
  Trace corners;
  double since = line_mm;
  Vector before{};
  for (int i = 0; i <= 400000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 400000, r = 12 + 4 * std::cos(5 * angle);
    Vector here{r * std::cos(angle) - 16, r * std::sin(angle), 0};
    if (i > 0) since += distance(before, here);
    before = here;
    if (since < line_mm) continue;
    since = 0;
    if (rounding_mm > 0)
      for (double& c : here) c = std::round(c / rounding_mm) * rounding_mm;
    corners.push_back(here);
  }
  return corners;
}

/// Queues lines through corners, and checks that the path keeps their tolerance and the limits.
double machined(const Trace& corners, double tolerance_mm, int cycles_between = 0, double jerk_mm_s3 = 50000) {
  PlannerBench bench(mill(jerk_mm_s3));
  if (cycles_between > 0) bench.planner.command(PathCommand::Run);
  Move move;
  move.feed_mm_s = 100;
  move.tolerance_mm = tolerance_mm;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    move.id = static_cast<std::int64_t>(i);
    move.geometry = LineGeometry{{corners[i - 1], kUp}, {corners[i], kUp}};
    EXPECT_TRUE(bench.queue(move));
    for (int k = 0; k < cycles_between; ++k) bench.cycle();
  }
  bench.planner.command(PathCommand::Run);
  EXPECT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), corners.size() - 1);
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  const Trace path = travelled(bench);
  EXPECT_LT(distance(path.back(), corners.back()), 1e-9);
  double off = 0;
  for (const Vector& p : path) off = std::max(off, distance_to_trace(p, corners));
  EXPECT_LE(off, tolerance_mm + 1e-9);
  off = 0;
  for (const Vector& p : corners) off = std::max(off, distance_to_trace(p, path));
  EXPECT_LE(off, tolerance_mm + 2e-4);
  expect_limits_and_order(bench);
  return seconds(bench);
}

TEST(ShortLines, RunAsFastAsTheCurveTheyCameFromHoweverShort) {
  const double fifths = machined(rose(0.2), 0.01);
  EXPECT_NEAR(machined(rose(0.1), 0.01) / fifths, 1, 0.02);
  EXPECT_NEAR(machined(rose(0.05), 0.01) / fifths, 1, 0.02);
  EXPECT_NEAR(machined(rose(0.1, 0.001), 0.01) / fifths, 1, 0.05);
}

TEST(ShortLines, WhoseChordsMissTheCurveByMoreThanTheToleranceAreNotStoppedAtEachCorner) {
  const double fine = machined(rose(0.1), 0.01);
  EXPECT_LT(machined(rose(0.3), 0.01), 1.15 * fine);
  EXPECT_LT(machined(rose(0.5), 0.01), 1.5 * fine);
  EXPECT_LT(machined(rose(1), 0.01), 3.71) << "on the smoothest spline it takes 3.75 s";
}

/// A closed curve in a plane, of five waves each way, in lines.
Trace waves(unsigned seed, double line_mm) {
  std::mt19937 random(seed);
  std::array<std::array<double, 5>, 2> height{}, phase{};
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t k = 0; k < 5; ++k) {
      height[c][k] = std::uniform_real_distribution<double>(-12, 12)(random) / static_cast<double>(k + 1);
      phase[c][k] = std::uniform_real_distribution<double>(0, 2 * std::numbers::pi)(random);
    }
  }
  Trace corners;
  Vector start{}, before{};
  for (int i = 0; i <= 200000; ++i) {
    Vector here{};
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t k = 0; k < 5; ++k)
        here[c] += height[c][k] * std::sin(static_cast<double>(k + 1) * i * std::numbers::pi / 100000 + phase[c][k]);
    }
    if (i == 0) start = here;
    for (std::size_t c = 0; c < 2; ++c) here[c] -= start[c];
    if (i > 0 && distance(before, here) < line_mm) continue;
    before = here;
    corners.push_back(here);
  }
  return corners;
}

Trace rounded(Trace corners, double step_mm) {
  for (Vector& corner : corners)
    for (double& c : corner) c = std::round(c / step_mm) * step_mm;
  return corners;
}

class RoundedLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(RoundedLines, RunAsFastAsExactOnes) {
  const double exact = machined(waves(GetParam(), 0.1), 0.01);
  for (const double line_mm : {0.02, 0.05, 0.1})
    EXPECT_LT(machined(rounded(waves(GetParam(), line_mm), 0.001), 0.01), 1.02 * exact) << line_mm;
}

TEST_P(RoundedLines, UseMoreTolerance) {
  const Trace corners = rounded(waves(GetParam(), 0.1), 0.001);
  double before = machined(corners, 0.003);
  for (const double tolerance_mm : {0.01, 0.05}) {
    const double now = machined(corners, tolerance_mm);
    EXPECT_LT(now, 1.002 * before) << tolerance_mm;
    before = now;
  }
}

// Where a bend is too tight for a spline within the tolerance, that costs time there and not for the lines around it.
TEST_P(RoundedLines, AreNotSlowerTheFinerTheyAre) {
  EXPECT_LT(machined(rounded(waves(GetParam(), 0.02), 0.001), 0.003),
            1.02 * machined(rounded(waves(GetParam(), 0.2), 0.001), 0.003));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundedLines, seeds(8));

class CoarseLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(CoarseLines, FindALawAlsoWhereJerkIsLow) {
  for (const double line_mm : {0.8, 1.2, 1.8}) {
    const Trace corners = waves(GetParam(), line_mm);
    // A law that is slowed down by the third root of what the jerk is less by keeps every limit.
    EXPECT_LT(machined(corners, 0.04, 0, 10000), 1.01 * std::cbrt(5) * machined(corners, 0.04, 0, 50000)) << line_mm;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CoarseLines, seeds(8));

/// Lines of all lengths and directions in space, now dense, now coarse, with corners among them.
Trace wandering(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Trace corners{{0, 0, 0}};
  Vector ahead{1, 0, 0}, turn{};
  double line = 1;
  for (int i = 0; i < 300; ++i) {
    if (i % 40 == 0) {
      line = std::exp(uniform(std::log(0.05), std::log(3.0)));
      for (double& c : turn) c = uniform(-0.4, 0.4);
    }
    for (std::size_t c = 0; c < 3; ++c) ahead[c] += turn[c] * std::min(1.0, 2 * line) + uniform(-0.1, 0.1);
    if (uniform(0, 1) < 0.02) ahead = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double length = distance(ahead, {0, 0, 0});
    const double step = line * uniform(0.3, 1);
    Vector next = corners.back();
    for (std::size_t c = 0; c < 3; ++c) {
      ahead[c] /= length;
      if (std::abs(next[c] + step * ahead[c]) > 45) ahead[c] = -ahead[c];
      next[c] += step * ahead[c];
    }
    corners.push_back(next);
  }
  return corners;
}

class WanderingLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(WanderingLines, KeepToleranceAndLimits) {
  const double tolerance = std::array{0.002, 0.01, 0.05, 0.3}[GetParam() % 4];
  machined(wandering(GetParam()), tolerance);
}

INSTANTIATE_TEST_SUITE_P(Seeds, WanderingLines, seeds(24));

TEST(ShortLines, OfASlowClientEndExactly) {
  Trace corners = rose(0.2);
  corners.resize(60);
  machined(corners, 0.01, 15);
}

TEST(ShortLines, KeepTheCornersThatWereMeant) {
  Trace corners;
  for (int i = 0; i <= 40; ++i) corners.push_back({i * 0.1, 0, 0});
  for (int i = 1; i <= 40; ++i) corners.push_back({4, i * 0.1, 0});
  machined(corners, 0.01);
}

}  // namespace
}  // namespace rmac::test
