#include "rmac/motion/time_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner_bench.hpp"

namespace rmac {
namespace {

/// Time a straight rest-to-rest move of one joint needs at least, in closed form.
double shortest_time(double length, double v, double a, double j) {
  const auto ramp = [&](double top) { return top * j >= a * a ? top / a + a / j : 2 * std::sqrt(top / j); };
  if (ramp(v) * v <= length) return length / v + ramp(v);
  double low = 0, high = v;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (ramp(middle) * middle > length ? high : low) = middle;
  }
  return 2 * ramp(low);
}

TEST(LawPiece, FollowsItsDifferentialEquationForEverySlope) {
  // a = a0 + slope (s - s0): checked by derivatives of s(t) taken with central differences.
  for (const double slope : {-400.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 400.0}) {
    const LawPiece piece{0, {5, 3, -2}, slope, 0.2, LawPiece::Kind::Linear};
    for (double t = 0.01; t < 0.2; t += 0.01) {
      const double h = 1e-4;
      const PathState before = piece.at(t - h), here = piece.at(t), after = piece.at(t + h);
      EXPECT_NEAR((after.s - before.s) / (2 * h), here.v, 1e-4 * (1 + std::abs(slope)))
          << "slope " << slope << " t " << t;
      EXPECT_NEAR((after.v - before.v) / (2 * h), here.a, 1e-4 * (1 + std::abs(slope)))
          << "slope " << slope << " t " << t;
      EXPECT_NEAR(here.a, -2 + slope * (here.s - 5), 1e-9 * (1 + std::abs(slope)));
    }
  }
}

TEST(TimeLaw, OfAStraightLineIsWithinThreePercentOfTheClosedForm) {
  for (const double length : {0.3, 1.0, 10.0, 45.0}) {
    for (const double feed : {1.0, 33.0, 200.0}) {
      test::PlannerBench bench(test::mill());
      bench.planner.command(PathCommand::Run);
      Move move;
      move.id = 1;
      move.feed_mm_s = feed;
      move.geometry = LineGeometry{{{0, 0, 0}, {0, 0, 1}}, {{length, 0, 0}, {0, 0, 1}}};
      ASSERT_TRUE(bench.queue(move)) << length;
      ASSERT_TRUE(bench.run());
      std::size_t moving = 0;
      for (const Setpoint& setpoint : bench.record) moving += setpoint.moving ? 1U : 0U;
      const double shortest = shortest_time(length, feed, 1000, 10000);
      EXPECT_LE(static_cast<double>(moving) * 1e-3, shortest * 1.03 + 0.002) << "length " << length << " feed " << feed;
      EXPECT_NEAR(bench.record.back().position[0], length, 1e-9);
    }
  }
}

}  // namespace
}  // namespace rmac
