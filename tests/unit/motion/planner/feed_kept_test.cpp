// The programmed feed bounds the tool whatever the override did: a plan that goes on from a law which was faster gives
// way to it, and to nothing more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>

#include "seeds.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// What the check of a law lets pass.
constexpr double kMost = 1.0005;
/// Until motion has settled behind an override that was lowered.
constexpr int kSettling = 600;

class FeedKept : public testing::TestWithParam<unsigned> {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double part) { return uniform(0, 1) < part; }

  /// Runs what is queued through holds and overrides, which are 100 half the time: the largest part of what the feed
  /// allowed, by the overrides that were in force lately, that the tool took.
  double fastest_part(test::PlannerBench& bench, const std::vector<double>& feeds, double lowest, double highest) {
    bench.planner.command(PathCommand::Run);
    double fastest = 0, percent = 100;
    std::deque<double> lately;
    int held = 0;
    for (int cycle = 0; cycle < 30'000 && bench.planner.moves_left() > 0; ++cycle) {
      bench.cycle();
      lately.push_back(percent);
      if (lately.size() > kSettling) lately.pop_front();
      const Setpoint& now = bench.record.back();
      if (now.move_id > 0) {
        const double feed = feeds[static_cast<std::size_t>(now.move_id) - 1];
        const double allowed = feed * *std::max_element(lately.begin(), lately.end()) / 100;
        fastest = std::max(fastest, now.feed_mm_s / allowed);
      }
      if (chance(0.01)) bench.planner.set_override(percent = chance(0.5) ? 100 : uniform(lowest, highest));
      if (held == 0 && chance(0.002)) {
        bench.planner.command(PathCommand::Stop);
        held = 60;
      } else if (held > 0 && --held == 0) {
        bench.planner.command(PathCommand::Run);
      }
    }
    EXPECT_EQ(bench.planner.moves_left(), 0U);
    return fastest;
  }

  PlannerModel some_mill(double joint_speed) {
    PlannerModel model = test::mill(logarithmic(10'000, 90'000));
    for (JointLimits& joint : model.joints) {
      joint.max_acceleration = logarithmic(1000, 5000);
      joint.max_speed = joint_speed;
    }
    return model;
  }
  /// Of a joint's speed: about it as often as not.
  double some_feed(double joint_speed) {
    return joint_speed * (chance(0.5) ? uniform(0.998, 1.0015) : uniform(0.6, 1.35));
  }

 private:
  std::mt19937 random_{GetParam()};
};

// On a circle the joints' bound of speed changes along the path, at times below the feed and at times above. Arcs of a
// third of the circles have feeds of their own.
TEST_P(FeedKept, OnACircle) {
  const double joint_speed = uniform(40, 120), feed = some_feed(joint_speed), radius = logarithmic(3, 20);
  const bool each_its_own = chance(0.33);
  std::vector<double> feeds;
  test::PlannerBench bench(some_mill(joint_speed));
  bench.builder.restart(std::vector<double>{radius, 0, 0}, {});
  bench.follower().hold_at(std::vector<double>{radius, 0, 0});
  const double arc = uniform(5, 60) * std::numbers::pi / 180;
  const int arcs = static_cast<int>(uniform(2, 4) * 2 * std::numbers::pi / arc);
  for (int i = 0; i < arcs; ++i) {
    Move move;
    move.id = i + 1;
    feeds.push_back(each_its_own ? feed * logarithmic(0.25, 1) : feed);
    move.feed_mm_s = feeds.back();
    ArcGeometry geometry;
    geometry.start = {{radius * std::cos(arc * i), radius * std::sin(arc * i), 0}, {0, 0, 1}};
    geometry.end = {{radius * std::cos(arc * (i + 1)), radius * std::sin(arc * (i + 1)), 0}, {0, 0, 1}};
    move.geometry = geometry;
    ASSERT_TRUE(bench.queue(move)) << i;
  }
  const bool over = chance(0.5);
  EXPECT_LE(fastest_part(bench, feeds, over ? 10 : 60, over ? 200 : 100), kMost);
}

TEST_P(FeedKept, OnALine) {
  const double joint_speed = uniform(40, 120), feed = some_feed(joint_speed);
  test::PlannerBench bench(some_mill(joint_speed));
  for (int i = 0; i < 20; ++i) {
    Move move;
    move.id = i + 1;
    move.feed_mm_s = feed;
    move.geometry = LineGeometry{{{2.2 * i, 0, 0}, {0, 0, 1}}, {{2.2 * (i + 1), 0, 0}, {0, 0, 1}}};
    ASSERT_TRUE(bench.queue(move)) << i;
  }
  EXPECT_LE(fastest_part(bench, std::vector<double>(20, feed), 60, 100), kMost);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FeedKept, test::seeds(24));

}  // namespace
}  // namespace rmac
