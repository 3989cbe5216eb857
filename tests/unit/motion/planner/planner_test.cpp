#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "seeds.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

using test::kUp;
using test::mill;
using test::PlannerBench;

/// A limit may be passed by rounding in third differences of positions of up to 50 mm, and by nothing else.
constexpr double kAtMost = 1.0005;

/// Programs of lines, arcs and NURBS with mixed feeds, the same for the same seed.
class RandomProgram {
 public:
  explicit RandomProgram(unsigned seed) : random_(seed) {}

  Move next(const ToolPose& from) {
    Move move;
    move.id = ++id_;
    move.feed_mm_s = pick({5, 20, 33.3, 80, 200});
    switch (std::uniform_int_distribution<int>(0, 4)(random_)) {
      case 0:
        move.geometry = LineGeometry{from, {point(), kUp}};
        break;
      case 1:
        move.geometry = full_circle(from);
        break;
      case 2:
        move.geometry = PathTargetGeometry{{point(), kUp}};
        break;
      case 3: {
        const Vector to = point();
        move.geometry = JointTargetGeometry{{to[0], to[1], to[2]}};
        break;
      }
      default:
        move.geometry = curve(from);
    }
    return move;
  }

  NurbsGeometry curve(const ToolPose& from) {
    NurbsGeometry geometry;
    geometry.curve.degree = std::uniform_int_distribution<int>(2, 5)(random_);
    const int count = std::uniform_int_distribution<int>(geometry.curve.degree + 1, 10)(random_);
    geometry.curve.points.push_back({from.tip[0], from.tip[1], from.tip[2]});
    for (int i = 1; i < count; ++i) {
      const Vector to = point();
      geometry.curve.points.push_back({to[0], to[1], to[2]});
    }
    const int spans = count - geometry.curve.degree;
    for (int i = 0; i < count + geometry.curve.degree + 1; ++i)
      geometry.curve.knots.push_back(std::clamp(i - geometry.curve.degree, 0, spans));
    return geometry;
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  Vector point() { return {uniform(-45, 45), uniform(-45, 45), uniform(-20, 20)}; }
  double pick(std::initializer_list<double> values) {
    return *(values.begin() + std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_));
  }
  static ArcGeometry full_circle(const ToolPose& from) {
    // Towards the middle of the travel, so that the circle stays inside it.
    const double radius = 3;
    const double length = std::max(std::hypot(from.tip[0], from.tip[1]), 1e-9);
    ArcGeometry arc;
    arc.center = {from.tip[0] - radius * from.tip[0] / length, from.tip[1] - radius * from.tip[1] / length,
                  from.tip[2]};
    arc.closed = true;
    arc.start = arc.end = from;
    return arc;
  }

  std::mt19937 random_;
  std::int64_t id_ = 0;
};

/// Queues `count` moves of a program; those that geometry forbids are left out.
void queue_program(PlannerBench& bench, RandomProgram& program, int count) {
  for (int queued = 0, tried = 0; queued < count && tried < 50 * count; ++tried) {
    if (bench.queue(program.next(bench.builder.end_pose()))) ++queued;
  }
}

void expect_limits_kept(const PlannerBench& bench, unsigned seed) {
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, kAtMost) << "seed " << seed;
  EXPECT_LE(peaks.acceleration, kAtMost) << "seed " << seed;
  EXPECT_LE(peaks.jerk, kAtMost) << "seed " << seed << " in cycle " << peaks.jerk_cycle;
}

class PlannerProperty : public ::testing::TestWithParam<unsigned> {};

TEST_P(PlannerProperty, KeepsEveryLimitAndFinishesEveryMove) {
  PlannerBench bench(mill(GetParam() % 2 == 0 ? 10000 : 50000));
  RandomProgram program(GetParam());
  queue_program(bench, program, 8);
  const std::size_t moves = bench.planner.moves_left();
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  expect_limits_kept(bench, GetParam());
  EXPECT_EQ(bench.moves_done(), moves);
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  EXPECT_EQ(bench.refused(), 0U);
  const auto end = bench.builder.end_joints();
  for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(bench.record.back().position[j], end[j], 1e-9);
}

// Red when moves are counted as left which samples already told to be done.
TEST_P(PlannerProperty, CountsWhatIsDoneWithoutPlanning) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 9000);
  queue_program(bench, program, 8);
  const std::size_t moves = bench.planner.moves_left();
  bench.planner.command(PathCommand::Run);
  while (bench.planner.moves_left() > 0) {
    bench.cycle();
    bench.cycles_without_planner(3);
    bench.planner.follow(bench.progress());
    ASSERT_EQ(bench.planner.moves_left(), moves - bench.moves_done()) << "seed " << GetParam();
  }
}

TEST_P(PlannerProperty, TellsThatAMoveIsDoneWhenTheMachineRestsAtItsEnd) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 7000);
  queue_program(bench, program, 4);
  while (bench.planner.moves_left() > 0) {
    bench.planner.command(PathCommand::RunOne);
    const std::size_t before = bench.moves_done();
    while (bench.moves_done() == before) bench.cycle();
    EXPECT_FALSE(bench.record.back().moving) << "seed " << GetParam();
    EXPECT_TRUE(bench.planner.at_rest(bench.progress())) << "seed " << GetParam();
    ASSERT_TRUE(bench.run());
    bench.planner.command(PathCommand::Stop);
  }
}

TEST_P(PlannerProperty, HoldsAndResumesAtAnyInstantOnThePathWithinLimits) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 1000);
  Move move;
  move.id = 1;
  move.feed_mm_s = program.uniform(5, 200);
  for (move.geometry = program.curve(bench.builder.end_pose()); !bench.queue(move);
       move.geometry = program.curve(bench.builder.end_pose())) {
  }
  bench.planner.command(PathCommand::Run);
  for (int hold = 0; hold < 6 && bench.planner.moves_left() > 0; ++hold) {
    const int until = static_cast<int>(program.uniform(1, 700));
    for (int i = 0; i < until; ++i) bench.cycle();
    bench.planner.command(PathCommand::Stop);
    ASSERT_TRUE(bench.run(20000)) << "no rest after a hold, seed " << GetParam();
    EXPECT_EQ(bench.record.back().feed_mm_s, 0);
    bench.planner.command(PathCommand::Run);
  }
  ASSERT_TRUE(bench.run());
  expect_limits_kept(bench, GetParam());
  EXPECT_EQ(bench.moves_done(), 1U);
}

TEST_P(PlannerProperty, TakesOverridesAtAnyInstantWithinLimits) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 2000);
  queue_program(bench, program, 5);
  const std::size_t moves = bench.planner.moves_left();
  bench.planner.command(PathCommand::Run);
  for (int step = 0; step < 30; ++step) {
    const int until = static_cast<int>(program.uniform(1, 300));
    for (int i = 0; i < until; ++i) bench.cycle();
    bench.planner.set_override(program.uniform(0, 200));
  }
  bench.planner.set_override(200);
  ASSERT_TRUE(bench.run());
  expect_limits_kept(bench, GetParam());
  EXPECT_EQ(bench.moves_done(), moves);
}

TEST_P(PlannerProperty, TakesOverridesFasterThanItPlans) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 5000);
  queue_program(bench, program, 3);
  bench.planner.command(PathCommand::Run);
  for (int step = 0; step < 400 && bench.planner.moves_left() > 0; ++step) {
    bench.cycles_with_late_planner(1 + step % 7);
    bench.planner.set_override(program.uniform(-50, 200));  // zero now and then
    bench.planner.command(step % 5 == 4 ? PathCommand::Stop : PathCommand::Run);
    for (int i = 0; i < step % 3; ++i) bench.cycle();
  }
  bench.planner.command(PathCommand::Run);
  bench.planner.set_override(100);
  ASSERT_TRUE(bench.run());
  expect_limits_kept(bench, GetParam());
}

TEST_P(PlannerProperty, RestsAtTheEndOfWhatASlowClientSentAndGoesOn) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 3000);
  bench.planner.command(PathCommand::Run);
  std::size_t sent = 0;
  for (int i = 0; i < 12; ++i) {
    Move move = program.next(bench.builder.end_pose());
    if (bench.queue(move)) ++sent;
    const int wait = static_cast<int>(program.uniform(0, 800));
    for (int k = 0; k < wait; ++k) bench.cycle();
  }
  ASSERT_TRUE(bench.run());
  expect_limits_kept(bench, GetParam());
  EXPECT_EQ(bench.moves_done(), sent);
}

TEST_P(PlannerProperty, KeepsLimitsAndFeedWhenThePlannerIsLate) {
  PlannerBench bench(mill());
  RandomProgram program(GetParam() + 4000);
  queue_program(bench, program, 6);
  const std::size_t moves = bench.planner.moves_left();
  bench.planner.command(PathCommand::Run);
  const int longest = 1 << (GetParam() + 1);
  for (int i = 0; i < 400000 && bench.planner.moves_left() > 0; ++i) {
    bench.cycles_with_late_planner(static_cast<int>(program.uniform(1, longest + 1)));
    if (i % 50 == 49) {
      bench.planner.command(PathCommand::Stop);
      bench.cycles_with_late_planner(longest);
      bench.planner.command(PathCommand::Run);
    }
  }
  expect_limits_kept(bench, GetParam());
  EXPECT_EQ(bench.moves_done(), moves);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlannerProperty, test::seeds(6));

TEST(Planner, PassesCollinearLinesAtFullFeed) {
  PlannerBench bench(mill());
  Move move;
  move.feed_mm_s = 30;
  for (int i = 0; i < 40; ++i) {
    move.id = i;
    move.geometry = LineGeometry{{{static_cast<double>(i), 0, 0}, kUp}, {{i + 1.0, 0, 0}, kUp}};
    ASSERT_TRUE(bench.queue(move));
  }
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  for (const Setpoint& setpoint : bench.record) {
    if (setpoint.position[0] > 4 && setpoint.position[0] < 36) {
      EXPECT_NEAR(setpoint.feed_mm_s, 30, 0.1);
    }
  }
  EXPECT_EQ(bench.moves_done(), 40U);
}

TEST(Planner, IsNotSlowedByAToleranceThatACurveHasNoUseFor) {
  for (const int count : {41, 51, 61, 101, 300}) {  // with some of these, path lengths meet only to rounding
    const auto time = [&](double tolerance) {
      PlannerBench bench(mill(50000));
      NurbsGeometry geometry;
      geometry.curve.degree = 3;
      for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / (count - 1), r = 30 + 10 * std::cos(5 * angle);
        geometry.curve.points.push_back({r * std::cos(angle), r * std::sin(angle), 0});
      }
      for (int i = 0; i < count + 4; ++i) geometry.curve.knots.push_back(std::clamp(i - 3, 0, count - 3));
      bench.builder.restart(std::vector<double>{40, 0, 0}, {});
      Move move;
      move.feed_mm_s = 100;
      move.tolerance_mm = tolerance;
      move.geometry = geometry;
      EXPECT_TRUE(bench.queue(move));
      bench.planner.command(PathCommand::Run);
      EXPECT_TRUE(bench.run());
      return static_cast<double>(bench.record.size());
    };
    EXPECT_LE(time(0.01), 1.01 * time(0)) << count << " poles";
  }
}

TEST(Planner, StopsExactlyInACornerWithoutTolerance) {
  PlannerBench bench(mill());
  Move move;
  move.feed_mm_s = 30;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{10, 0, 0}, kUp}};
  ASSERT_TRUE(bench.queue(move));
  move.geometry = LineGeometry{{{10, 0, 0}, kUp}, {{10, 10, 0}, kUp}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  double slowest = 30;
  for (const Setpoint& setpoint : bench.record) {
    EXPECT_LT(std::min(std::abs(setpoint.position[1]), std::abs(setpoint.position[0] - 10)),
              1e-9);  // never off the corner
    if (std::abs(setpoint.position[0] - 10) < 0.01 && setpoint.position[1] < 0.01)
      slowest = std::min(slowest, setpoint.feed_mm_s);
  }
  EXPECT_LT(slowest, 0.1);
}

TEST(Planner, KeepsLimitsThroughNearCuspsFarAlongAMove) {
  for (const double gap : {1.0, 0.3, 0.1}) {  // the last one's sharpest radius is 26 nm
    PlannerBench bench(mill(50000));
    Move move;
    move.feed_mm_s = 200;
    NurbsGeometry geometry;
    // The curve's legs cross; with the gap closed it would have a cusp halfway.
    geometry.curve = {3, 3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0, 0}, {40, 40, 0}, {gap, 40, 0}, {40, 0, 0}}, {}};
    move.geometry = geometry;
    ASSERT_TRUE(bench.queue(move));
    bench.planner.command(PathCommand::Run);
    ASSERT_TRUE(bench.run());
    EXPECT_LE(bench.peaks().jerk, kAtMost) << gap;
    EXPECT_LE(bench.peaks().acceleration, kAtMost) << gap;
  }
}

TEST(Planner, NeverPassesTheLargestFeedWhateverTheOverride) {
  PlannerModel model = mill();
  model.max_feed_mm_s = 2000.0 / 60;
  PlannerBench bench(model);
  Move move;
  move.feed_mm_s = 30;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{40, 0, 0}, kUp}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.set_override(200);
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  double fastest = 0;
  for (const Setpoint& setpoint : bench.record) fastest = std::max(fastest, setpoint.feed_mm_s);
  EXPECT_NEAR(fastest, 2000.0 / 60, 0.05);
}

TEST(Planner, RunsOneMoveInManualMode) {
  PlannerBench bench(mill());
  Move move;
  move.feed_mm_s = 30;
  for (int i = 0; i < 3; ++i) {
    move.id = i;
    move.geometry = LineGeometry{{{i * 5.0, 0, 0}, kUp}, {{i * 5.0 + 5, 0, 0}, kUp}};
    ASSERT_TRUE(bench.queue(move));
  }
  for (int i = 1; i <= 3; ++i) {
    bench.planner.command(PathCommand::RunOne);
    ASSERT_TRUE(bench.run());
    EXPECT_NEAR(bench.record.back().position[0], 5.0 * i, 1e-9);
    EXPECT_EQ(bench.moves_done(), static_cast<std::size_t>(i));
  }
}

TEST(Planner, BrakesForAHoldWithinTwoCyclesAndInAShortDistance) {
  PlannerBench bench(mill());
  Move move;
  move.feed_mm_s = 100;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{45, 0, 0}, kUp}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  while (bench.record.empty() || bench.record.back().position[0] < 15) bench.cycle();
  const double at = bench.record.back().position[0];
  bench.planner.command(PathCommand::Stop);
  for (int i = 0; i < 4; ++i) bench.cycle();
  EXPECT_LT(bench.record.back().acceleration[0], 0);
  ASSERT_TRUE(bench.run());
  const double shortest = 0.5 * 100 * (100.0 / 1000 + 1000.0 / 10000) + 2 * 0.1;
  EXPECT_LE(bench.record.back().position[0] - at, 1.1 * shortest);
}

TEST(Planner, ShapesMovesByPathAcceleration) {
  const auto peak = [](double rise, double fall) {
    PlannerBench bench(mill());
    Move move;
    move.feed_mm_s = 50;
    move.accel_rise_mm_s2 = rise;
    move.accel_fall_mm_s2 = fall;
    move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{40, 0, 0}, kUp}};
    EXPECT_TRUE(bench.queue(move));
    bench.planner.command(PathCommand::Run);
    EXPECT_TRUE(bench.run());
    std::pair<double, double> peaks{0, 0};
    for (const Setpoint& setpoint : bench.record) {
      peaks.first = std::max(peaks.first, setpoint.acceleration[0]);
      peaks.second = std::max(peaks.second, -setpoint.acceleration[0]);
    }
    return peaks;
  };
  const auto [rise, fall] = peak(200, 100);
  EXPECT_NEAR(rise, 200, 5);
  EXPECT_NEAR(fall, 100, 5);
  EXPECT_GT(peak(0, 0).first, 500);
}

}  // namespace
}  // namespace rmac
