#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "seeds.hpp"
#include "unit/motion/joins/traces.hpp"

namespace rmac::test {
namespace {

/// Passes over a free-form face, to and fro, in lines whose chords miss it by a micrometre, rounded to that; a short
/// line ends each, and a step to the side leads to the next.
Trace raster(unsigned seed) {
  std::mt19937 random(seed);
  const double begin = std::uniform_real_distribution<double>(-30, 30)(random);
  const double over = std::uniform_real_distribution<double>(0.05, 0.15)(random);
  const auto face = [](double x, double y) {
    return 3 * std::sin(x / 8) * std::cos(y / 6) + 2 * std::sin((x + y) / 11);
  };
  constexpr double kHalf_mm = 40;
  Trace corners;
  for (int pass = 0; pass < 40; ++pass) {
    const double way = pass % 2 == 0 ? 1 : -1, y = begin + pass * over;
    for (double x = -kHalf_mm;;) {
      corners.push_back({way * x, y, face(way * x, y)});
      if (x >= kHalf_mm) break;
      const double bend = (face(way * x + 0.01, y) - 2 * face(way * x, y) + face(way * x - 0.01, y)) / 1e-4;
      x = std::min(x + std::clamp(std::sqrt(0.008 / std::abs(bend)), 0.1, 0.8), kHalf_mm);
    }
  }
  for (std::size_t i = corners.size(); i-- > 0;)
    for (std::size_t c = 0; c < 3; ++c) corners[i][c] = std::round(1000 * (corners[i][c] - corners[0][c])) / 1000;
  return corners;
}

class Rasters : public ::testing::TestWithParam<unsigned> {};

TEST_P(Rasters, StepOverWithoutRest) {
  PlannerModel model = mill(50000);
  for (JointLimits& joint : model.joints) {
    joint.max_acceleration = 2000;
    joint.max = 100;
  }
  const Trace corners = raster(GetParam());
  PlannerBench bench(model);
  Move move;
  move.feed_mm_s = 200;
  move.tolerance_mm = 0.01;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    move.id = static_cast<std::int64_t>(i);
    move.geometry = LineGeometry{{corners[i - 1], kUp}, {corners[i], kUp}};
    ASSERT_TRUE(bench.queue(move));
  }
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_LT(distance(travelled(bench).back(), corners.back()), 1e-9);
  int stops = 0;
  bool moved = false;
  for (const Setpoint& setpoint : bench.record) {
    stops += moved && !setpoint.moving ? 1 : 0;
    moved = setpoint.moving;
  }
  EXPECT_LE(stops, 1);
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.acceleration, kAtMost);
  EXPECT_LE(peaks.jerk, kAtMost);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Rasters, seeds(8));

}  // namespace
}  // namespace rmac::test
