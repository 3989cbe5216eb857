// Every hold is answered within two cycles: the plan that is followed then ends at rest for it. So is every override:
// another plan has taken over then.
#include <gtest/gtest.h>

#include "seeds.hpp"
#include "unit/motion/planner/program_fuzz.hpp"

namespace rmac {
namespace {

using test::Action;
using test::mill;
using test::PlannerBench;

constexpr int kCyclesOnPath = 2;

void queue_program(PlannerBench& bench, unsigned seed) {
  std::int64_t id = 0;
  for (unsigned extra = 0; id < 6; ++extra) {
    for (const Action& action : test::random_program(seed + 1000 * extra).actions) {
      if (action.kind != Action::Kind::Queue) continue;
      if (bench.queue(test::move_of(action, id + 1, bench.builder.end_pose()))) ++id;
    }
  }
}

class PromptStop : public ::testing::TestWithParam<unsigned> {};

// As the servo thread does it: from the second cycle on it asks in each whether a plan stops the machine, and lets the
// joints leave the path where none does. A better stop that takes the place of the first must not look like none.
TEST_P(PromptStop, IsUnderWayFromTheSecondCycleOnUntilTheMachineRests) {
  PlannerBench bench(mill(GetParam() % 2 == 0 ? 10000 : 50000));
  std::mt19937 random(GetParam());
  queue_program(bench, GetParam());
  int holds = 0;
  while (bench.planner.moves_left() > 0) {
    bench.planner.command(PathCommand::Run);
    for (int wait = std::uniform_int_distribution(1, 300)(random); wait > 0; --wait) bench.cycle();
    if (!bench.record.back().moving) continue;
    ++holds;
    bench.planner.command(PathCommand::Stop);
    for (int cycle = 1; bench.record.back().moving; ++cycle) {
      ASSERT_LT(cycle, 20'000);
      if (cycle >= kCyclesOnPath) bench.follower().leave();
      bench.cycle();
      ASSERT_EQ(bench.progress().departure.count, 0U) << "hold " << holds << ", cycle " << cycle;
    }
  }
  EXPECT_GT(holds, 0);
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, 1.001);
  EXPECT_LE(peaks.acceleration, 1.001);
  EXPECT_LE(peaks.jerk, 1.001) << "in cycle " << peaks.jerk_cycle;
}

INSTANTIATE_TEST_SUITE_P(Seeds, PromptStop, test::seeds(12));

TEST(Override, ThatIsLoweredIsFollowedWithinTwoCyclesAndTheLimits) {
  PlannerBench bench(mill());
  Move move;
  move.id = 1;
  move.feed_mm_s = 60;
  move.geometry = LineGeometry{{{0, 0, 0}, {0, 0, 1}}, {{45, 20, 0}, {0, 0, 1}}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  while (bench.record.empty() || bench.record.back().feed_mm_s < 59) bench.cycle();
  const std::uint64_t before = bench.progress().accepted_plan;
  bench.planner.set_override(50);
  for (int i = 0; i < 2; ++i) bench.cycle();
  EXPECT_GT(bench.progress().accepted_plan, before);
  double slowest = 1e9;
  for (int i = 0; i < 250; ++i) {
    bench.cycle();
    slowest = std::min(slowest, bench.record.back().feed_mm_s);
  }
  EXPECT_NEAR(bench.record.back().feed_mm_s, 30, 0.1);
  EXPECT_GT(slowest, 28) << "it does not stop for it";
  ASSERT_TRUE(bench.run());
  EXPECT_LE(bench.peaks().jerk, 1.001);
}

/// A spline through places at random, which bends sharply here and there.
Nurbs winding(std::mt19937& random) {
  const auto within = [&](double most) { return std::uniform_real_distribution(-most, most)(random); };
  Nurbs nurbs;
  nurbs.degree = 4;
  nurbs.points.push_back({0, 0, 0});
  for (int i = 1; i < 10; ++i) nurbs.points.push_back({within(40), within(40), within(10)});
  nurbs.knots = {0, 0, 0, 0};
  for (int i = 0; i <= 6; ++i) nurbs.knots.push_back(i);
  nurbs.knots.insert(nurbs.knots.end(), 4, 6);
  return nurbs;
}

class PromptOverride : public ::testing::TestWithParam<unsigned> {};

// In sharp bends no law leaves the plan at once, as its state is at the limits on every side; one that leaves it later
// takes over all the same. Where motion is about to end, slower than either feed, the plan is as good
// as any, and nothing takes over.
TEST_P(PromptOverride, HasAPlanThatTakesOverWithinTwoCycles) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  PlannerBench bench(mill(50000));
  Move move;
  move.id = 1;
  move.feed_mm_s = uniform(20, 200);
  move.geometry = NurbsGeometry{NurbsSpace::Tip, winding(random)};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  double percent = 100;
  int overrides = 0;
  while (bench.planner.moves_left() > 0) {
    for (int wait = std::uniform_int_distribution(20, 200)(random); wait > 0; --wait) bench.cycle();
    if (!(bench.record.back().feed_mm_s > 1)) continue;
    const bool lowered = uniform(0, 200) < percent;
    percent = lowered ? uniform(1, percent) : uniform(percent, 200);
    const std::uint64_t before = bench.progress().accepted_plan;
    bench.planner.set_override(percent);
    for (int cycle = 0; cycle < kCyclesOnPath; ++cycle) bench.cycle();
    const bool answered = bench.progress().accepted_plan > before;
    ++overrides;
    if (!answered) {
      ASSERT_LT(bench.record.back().feed_mm_s, percent / 100 * move.feed_mm_s) << "override " << overrides;
      while (bench.progress().accepted_plan == before && bench.record.back().moving) bench.cycle();
      ASSERT_EQ(bench.progress().accepted_plan, before) << "override " << overrides << ": " << percent;
    }
    percent = percent < 20 ? 100 : percent;  // or it takes long
    bench.planner.set_override(percent);
  }
  EXPECT_GT(overrides, 0);
  ASSERT_TRUE(bench.run());
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, 1.001);
  EXPECT_LE(peaks.acceleration, 1.001);
  EXPECT_LE(peaks.jerk, 1.001) << "in cycle " << peaks.jerk_cycle;
}

INSTANTIATE_TEST_SUITE_P(Seeds, PromptOverride, test::seeds(80));

}  // namespace
}  // namespace rmac
