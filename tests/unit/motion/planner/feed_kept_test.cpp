// The programmed feed bounds the tool whatever the override did: a plan that goes on from a law which was faster gives
// way to it, and to nothing more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "seeds.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

class FeedKept : public testing::TestWithParam<unsigned> {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double part) { return uniform(0, 1) < part; }

 private:
  std::mt19937 random_{GetParam()};
};

// On a circle the joints' bound of speed changes along the path, at times below the feed and at times above.
TEST_P(FeedKept, OnACircleThroughHoldsAndOverrides) {
  const double joint_speed = uniform(40, 120), feed = joint_speed * uniform(0.6, 1.35), radius = logarithmic(3, 20);
  PlannerModel model = test::mill(logarithmic(10'000, 90'000));
  for (JointLimits& joint : model.joints) {
    joint.max_acceleration = logarithmic(1000, 5000);
    joint.max_speed = joint_speed;
  }
  test::PlannerBench bench(model);
  bench.builder.restart(std::vector<double>{radius, 0, 0}, {});
  bench.follower().hold_at(std::vector<double>{radius, 0, 0});
  const double arc = uniform(5, 60) * std::numbers::pi / 180;
  const int arcs = static_cast<int>(uniform(2, 4) * 2 * std::numbers::pi / arc);
  for (int i = 0; i < arcs; ++i) {
    Move move;
    move.id = i + 1;
    move.feed_mm_s = feed;
    ArcGeometry geometry;
    geometry.start = {{radius * std::cos(arc * i), radius * std::sin(arc * i), 0}, {0, 0, 1}};
    geometry.end = {{radius * std::cos(arc * (i + 1)), radius * std::sin(arc * (i + 1)), 0}, {0, 0, 1}};
    move.geometry = geometry;
    ASSERT_TRUE(bench.queue(move)) << i;
  }
  bench.planner.command(PathCommand::Run);
  double fastest = 0;
  int held = 0;
  for (int cycle = 0; cycle < 20'000 && bench.planner.moves_left() > 0; ++cycle) {
    bench.cycle();
    fastest = std::max(fastest, bench.record.back().feed_mm_s);
    if (chance(0.01)) bench.planner.set_override(chance(0.5) ? 100 : uniform(60, 100));
    if (held == 0 && chance(0.002)) {
      bench.planner.command(PathCommand::Stop);
      held = 60;
    } else if (held > 0 && --held == 0) {
      bench.planner.command(PathCommand::Run);
    }
  }
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  EXPECT_LE(fastest, 1.0005 * feed);
  EXPECT_GT(fastest, 0.5 * std::min(feed, joint_speed));
}

INSTANTIATE_TEST_SUITE_P(Seeds, FeedKept, test::seeds(16));

}  // namespace
}  // namespace rmac
