// A held machine runs back along its path, and forward again over the same ground, as if nothing had been.
#include <gtest/gtest.h>

#include <map>

#include "seeds.hpp"
#include "unit/motion/planner/program_fuzz.hpp"

namespace rmac {
namespace {

using test::Action;
using test::mill;
using test::PlannerBench;

constexpr double kMostInARetrace = 1.001;

/// A bench with a random program in its queue that knows where its moves lie.
class RetraceBench {
 public:
  explicit RetraceBench(unsigned seed) : bench(mill(seed % 2 == 0 ? 10000 : 50000)), random_(seed) {
    for (unsigned extra = 0; queued < 6; ++extra) {
      for (Action& action : test::random_program(seed + 1000 * extra).actions) {
        if (action.kind != Action::Kind::Queue) continue;
        if (seed % 3 != 0) action.tolerance_mm = 0;
        tolerance = std::max(tolerance, action.tolerance_mm);
        queue(action);
      }
    }
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  void run_for(double cycles) {
    for (int i = 0; i < static_cast<int>(cycles); ++i) bench.cycle();
  }
  [[nodiscard]] bool hold() {
    bench.planner.command(PathCommand::Stop);
    return bench.run(20000);
  }
  /// How far a setpoint lies off the move that it names, at the length that it names.
  [[nodiscard]] double off_path(const Setpoint& setpoint) const {
    const auto moves = moves_.find(setpoint.move_id);
    if (moves == moves_.end()) return 0;  // before the first
    double nearest = 1e9;
    for (const auto& segment : moves->second) {
      const auto& stretch = segment->stretches().front();
      const double s = std::clamp(setpoint.s_mm - stretch.s_begin_mm, 0.0, segment->length());
      JointPoint point;
      EXPECT_EQ(segment->evaluate(s, 0, 1, point), KinematicsStatus::Ok);
      nearest = std::min(nearest, std::hypot(point.d[0][0] - setpoint.position[0], point.d[0][1] - setpoint.position[1],
                                             point.d[0][2] - setpoint.position[2]));
    }
    return nearest;
  }
  void expect_whole_program_done() {
    bench.planner.command(PathCommand::Run);
    ASSERT_TRUE(bench.run());
    const auto peaks = bench.peaks();
    EXPECT_LE(peaks.velocity, kMostInARetrace);
    EXPECT_LE(peaks.acceleration, kMostInARetrace);
    EXPECT_LE(peaks.jerk, kMostInARetrace) << "in cycle " << peaks.jerk_cycle;
    EXPECT_EQ(bench.moves_done(), queued);
    EXPECT_EQ(bench.planner.moves_left(), 0U);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(bench.record.back().position[j], bench.builder.end_joints()[j], 1e-9);
    if (tolerance > 0) return;
    for (const Setpoint& setpoint : bench.record) ASSERT_LE(off_path(setpoint), 1e-6);
  }

  PlannerBench bench;
  std::size_t queued = 0;
  double tolerance = 0;

 private:
  void queue(const Action& action) {
    const Move move = test::move_of(action, static_cast<std::int64_t>(queued) + 1, bench.builder.end_pose());
    auto segments = bench.builder.build(move);
    if (!segments) return;
    ++queued;
    moves_[move.id] = *segments;
    bench.planner.add(std::move(*segments));
  }

  std::mt19937 random_;
  std::map<std::int64_t, PathSegments> moves_;
};

class Retrace : public ::testing::TestWithParam<unsigned> {};

TEST_P(Retrace, RunsBackAndForwardWithinLimitsAndCountsEachMoveOnce) {
  RetraceBench machine(GetParam());
  PlannerBench& bench = machine.bench;
  for (int round = 0; round < 4 && bench.planner.moves_left() > 0; ++round) {
    bench.planner.command(PathCommand::Run);
    machine.run_for(machine.uniform(200, 3000));
    ASSERT_TRUE(machine.hold());
    const std::size_t done = bench.moves_done();
    const double asked = std::exp(machine.uniform(std::log(0.01), std::log(200)));
    const double way = bench.turn_back(asked);
    EXPECT_LE(way, asked + 1e-9);
    bench.planner.command(PathCommand::Retrace);
    if (round % 2 == 0) {
      ASSERT_TRUE(bench.run(200000));
      EXPECT_TRUE(bench.planner.retraced(bench.progress()));
    } else {  // held on the way back, and gone back further
      machine.run_for(machine.uniform(1, 400));
      ASSERT_TRUE(machine.hold());
      (void)bench.turn_back(asked);
      bench.planner.command(PathCommand::Retrace);
      machine.run_for(machine.uniform(1, 400));  // and told to go on while it still goes back
    }
    EXPECT_EQ(bench.moves_done(), done) << "a move that was done before is not done again";
  }
  machine.expect_whole_program_done();
  EXPECT_EQ(bench.refused(), 0U);
}

// Red when a refused plan left the planner with the end of the way back as a place of the queue's path: it went on half
// a millimetre away from where the machine stood.
TEST_P(Retrace, GoesOnFromWhereItStandsWhicheverPlansComeTooLate) {
  RetraceBench machine(GetParam());
  PlannerBench& bench = machine.bench;
  const auto run_late = [&](double cycles) {
    for (const std::size_t end = bench.record.size() + static_cast<std::size_t>(cycles); bench.record.size() < end;) {
      bench.cycles_with_late_planner(static_cast<int>(machine.uniform(1, 100)));
    }
  };
  const auto rest = [&] {
    do run_late(1);
    while (bench.record.back().moving || !bench.planner.at_rest(bench.progress()));
  };
  for (int round = 0; round < 6 && bench.planner.moves_left() > 0; ++round) {
    bench.planner.command(PathCommand::Run);
    run_late(machine.uniform(1, 2000));
    bench.planner.command(PathCommand::Stop);
    rest();
    (void)bench.turn_back(std::exp(machine.uniform(std::log(0.01), std::log(20))));
    bench.planner.command(PathCommand::Retrace);
    run_late(machine.uniform(1, 2000));
    bench.planner.command(PathCommand::Stop);
    rest();
  }
  EXPECT_GT(bench.refused(), 0U);
  EXPECT_EQ(bench.follower().departure().count, 0U);
  machine.expect_whole_program_done();
}

INSTANTIATE_TEST_SUITE_P(Seeds, Retrace, test::seeds(12));

/// Three lines of 5 mm along X.
void queue_lines(PlannerBench& bench) {
  Move move;
  move.feed_mm_s = 30;
  for (int i = 0; i < 3; ++i) {
    move.id = i + 1;
    move.geometry = LineGeometry{{{i * 5.0, 0, 0}, {0, 0, 1}}, {{i * 5.0 + 5, 0, 0}, {0, 0, 1}}};
    ASSERT_TRUE(bench.queue(move));
  }
}

TEST(Retracing, EndsAfterTheDistanceAskedFor) {
  PlannerBench bench(mill());
  queue_lines(bench);
  bench.planner.command(PathCommand::Run);
  while (bench.record.empty() || bench.record.back().position[0] < 11) bench.cycle();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run());
  const double held = bench.record.back().position[0];
  EXPECT_DOUBLE_EQ(bench.turn_back(9), 9);
  bench.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], held - 9, 1e-9);
  EXPECT_EQ(bench.record.back().move_id, 1);
  // The rest of the way ends where the path began.
  EXPECT_NEAR(bench.turn_back(1000), held - 9, 1e-6);
  bench.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], 0, 1e-9);
  EXPECT_EQ(bench.turn_back(1), 0);
}

TEST(Retracing, LeavesAOneMoveRunToEndTheMoveThatWasHeld) {
  PlannerBench bench(mill());
  queue_lines(bench);
  bench.planner.command(PathCommand::RunOne);
  ASSERT_TRUE(bench.run());
  bench.planner.command(PathCommand::RunOne);
  while (bench.record.back().position[0] < 7) bench.cycle();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run());
  ASSERT_GT(bench.turn_back(6), 5);
  bench.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench.run());
  bench.planner.command(PathCommand::RunOne);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], 10, 1e-9);
  EXPECT_EQ(bench.moves_done(), 2U);
}

TEST(Retracing, IsForgottenWhenTheQueueIsEmptied) {
  PlannerBench bench(mill());
  queue_lines(bench);
  bench.planner.command(PathCommand::Run);
  while (bench.record.empty() || bench.record.back().position[0] < 11) bench.cycle();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run());
  ASSERT_GT(bench.turn_back(8), 0);
  bench.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench.run());
  const double x = bench.record.back().position[0];
  bench.planner.clear();
  EXPECT_EQ(bench.turn_back(1), 0);
  // What comes next is counted, although it lies on ground that was travelled before.
  const std::size_t done = bench.moves_done();
  bench.builder.restart(std::vector<double>{x, 0, 0}, {});
  Move move;
  move.feed_mm_s = 30;
  move.geometry = LineGeometry{{{x, 0, 0}, {0, 0, 1}}, {{x + 2, 0, 0}, {0, 0, 1}}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], x + 2, 1e-9);
  EXPECT_EQ(bench.moves_done(), done + 1);
}

}  // namespace
}  // namespace rmac
