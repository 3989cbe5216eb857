#include "time_law/window.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "joins/path_joiner.hpp"
#include "time_law/law_check.hpp"
#include "unit/motion/planner/planner_bench.hpp"

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

// Path lengths are sums: where a machine stands at the end of a move misses the end of its segment by rounding, either
// way.
TEST(TimeLaw, BeginsAndEndsAtBordersThatRoundingMisses) {
  test::PlannerBench bench(test::mill());
  PathSegments segments;
  std::vector<double> starts{0};
  const std::array<Vector, 5> corners{{{-45, 0, 0}, {45, 3, 0}, {-45, 6, 0}, {45, 9, 0}, {40, -40, 0}}};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Move move;
    move.id = static_cast<std::int64_t>(i);
    move.feed_mm_s = 30;
    move.geometry = LineGeometry{{corners[i], {0, 0, 1}}, {corners[i + 1], {0, 0, 1}}};
    if (i == 0) bench.builder.restart(std::vector<double>{-45, 0, 0}, {});
    auto built = bench.builder.build(move);
    ASSERT_TRUE(built) << built.error().message;
    ASSERT_EQ(built->size(), 1U);
    segments.push_back(built->front());
    starts.push_back(starts.back() + built->front()->length());
  }
  starts.pop_back();
  const PathView path(segments, starts);
  const auto joints = test::mill().joints;
  const double ulp = std::nextafter(starts[1], 1e9) - starts[1];
  for (const double at_begin : {-1e-10, -1e-12, -1.0, 0.0, 1.0, 1e-12, 1e-10}) {
    for (const double at_end : {-1e-10, -1e-12, -1.0, 0.0, 1.0, 1e-12, 1e-10}) {
      const auto by = [ulp](double off) { return std::abs(off) == 1 ? off * ulp : off; };
      const double from = starts[1] + by(at_begin), to = starts[2] + by(at_end);
      SCOPED_TRACE("off by " + std::to_string(at_begin) + " and " + std::to_string(at_end));
      const auto law = plan_window(path, joints, {{from, 0, 0}, to, {}});
      ASSERT_TRUE(law);
      EXPECT_LE(check_law(path, joints, *law, nullptr).worst, 1);
      EXPECT_NEAR(law->front().start.s, starts[1], 1e-9);
      EXPECT_NEAR(law->back().at(law->back().duration).s, starts[2], 1e-9);
      EXPECT_LT(law->back().t0 + law->back().duration, 3.3) << "90 mm at 30 mm/s";
    }
  }
}

// The step over of a raster: what a ramp from rest uses up on a line much shorter than itself, the corner behind needs.
TEST(TimeLaw, LeavesAndReachesRestOnALineMuchShorterThanARamp) {
  for (const double step_over : {0.05, 0.07, 0.1, 0.15, 0.2, 0.3}) {
    test::PlannerBench bench(test::mill());
    auto joints = test::mill(50000).joints;
    for (JointLimits& joint : joints) joint.max_acceleration = 2000;
    PathJoiner joiner(joints, 1e-3);
    const std::array<Vector, 4> corners{{{0, 0, 0}, {40, 0, 0}, {40, step_over, 0}, {0, step_over, 0}}};
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      Move move;
      move.id = static_cast<std::int64_t>(i);
      move.feed_mm_s = 200;
      move.tolerance_mm = 0.01;
      move.geometry = LineGeometry{{corners[i], {0, 0, 1}}, {corners[i + 1], {0, 0, 1}}};
      const auto built = bench.builder.build(move);
      ASSERT_TRUE(built);
      for (const auto& segment : *built) joiner.add(segment);
    }
    PathSegments segments;
    while (joiner.ready()) joiner.advance(segments);
    while (!joiner.empty()) joiner.release(segments);
    std::vector<double> starts{0};
    for (const auto& segment : segments) starts.push_back(starts.back() + segment->length());
    const double end = starts.back();
    starts.pop_back();
    const PathView path(segments, starts);
    for (const double part : {0.3, 0.5, 0.7}) {
      const double rest = 40 + part * step_over - 0.02;
      SCOPED_TRACE(std::to_string(step_over) + " mm, rest at " + std::to_string(rest));
      EXPECT_TRUE(plan_window(path, joints, {{rest, 0, 0}, end, {}}));
      EXPECT_TRUE(plan_window(path, joints, {{0, 0, 0}, rest, {}}));
    }
  }
}

}  // namespace
}  // namespace rmac
