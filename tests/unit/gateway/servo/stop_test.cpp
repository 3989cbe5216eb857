// Stops of the servo thread's own: nobody plans here, and nobody has to.
#include <gtest/gtest.h>

#include <random>

#include "gateway/servo/servo_cycle.hpp"
#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

constexpr double kPeriod_s = 0.001;

/// A machine without drives on a line along X, and its planner, which works only when it is asked to.
class StopBench {
 public:
  StopBench() : mechanism(CycleBench::make_mechanism(true)) {
    SwapRequest request;
    request.next = mechanism.get();
    request.generation = 1;
    link.swap = &request;
    ServoWishes wishes;
    wishes.power = true;
    link.wishes.write(wishes);
    while (!cycle.status().follows) run(1);
    mechanism->builder.restart({cycle.status().position_set.data(), 3}, {});
    auto segments = mechanism->builder.build(CycleBench::move_to(1, 40));
    EXPECT_TRUE(segments);
    mechanism->planner.add(std::move(*segments));
    mechanism->planner.command(PathCommand::Run);
  }

  void plan() {
    while (!mechanism->planner.idle(cycle.status().progress)) mechanism->planner.step(cycle.status().progress);
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle.run(0);
  }
  void run_planned(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      plan();
      run(1);
    }
  }
  [[nodiscard]] bool moving() const { return cycle.status().moving; }
  [[nodiscard]] std::uint64_t departures() const { return cycle.status().progress.departure.count; }
  /// Cycles until the machine stands.
  int cycles_to_rest() {
    int cycles = 0;
    for (; moving() && cycles < 100000; ++cycles) run(1);
    return cycles;
  }
  /// As the joint's limits need for it, from the speed that it has now.
  [[nodiscard]] double shortest_s() const {
    JointBrake brake(mechanism->planner_model.joints);
    const CycleSample now = link.history.latest();
    Setpoint setpoint;
    setpoint.position = now.position_set;
    setpoint.velocity = now.velocity_set;
    setpoint.acceleration = now.acceleration_set;
    brake.begin(setpoint);
    return brake.duration();
  }

  ServoLink link{1};
  std::shared_ptr<Mechanism> mechanism;
  ServoCycle cycle{link, kPeriod_s};
};

TEST(Stop, ComesWithinTwoCyclesOfBeingAskedForWhereNobodyPlans) {
  std::mt19937 random(4711);
  for (int i = 0; i < (kSanitized ? 60 : 300); ++i) {
    StopBench bench;
    bench.run_planned(std::uniform_int_distribution(5, 900)(random));
    if (!bench.moving()) continue;
    (i % 2 == 0 ? bench.link.stops.asked : bench.link.stops.kept) = true;
    bench.run(2);
    const double needed_s = bench.shortest_s();
    if (!bench.moving()) continue;
    EXPECT_LE(bench.cycles_to_rest(), std::ceil(needed_s / kPeriod_s)) << "case " << i;
    EXPECT_EQ(bench.departures(), 1U);
  }
}

TEST(Stop, TakesThePathsOwnLawWhereItIsThere) {
  StopBench bench;
  bench.run_planned(300);
  bench.link.stops.planned = true;
  bench.mechanism->planner.command(PathCommand::Stop);
  bench.run_planned(2000);
  EXPECT_FALSE(bench.moving());
  EXPECT_EQ(bench.departures(), 0U);
}

TEST(Stop, ThatIsAskedForAgainWhileItIsUnderWayStaysOnThePath) {
  StopBench bench;
  bench.run_planned(300);
  for (const PathCommand command : {PathCommand::Stop, PathCommand::Run, PathCommand::Stop}) {
    bench.link.stops.planned = command == PathCommand::Stop;
    bench.mechanism->planner.command(command);
    bench.run_planned(20);
    ASSERT_TRUE(bench.moving());
  }
  bench.run_planned(2000);
  EXPECT_FALSE(bench.moving());
  EXPECT_EQ(bench.departures(), 0U);
}

TEST(Stop, IsNoneOnceItIsTakenBack) {
  StopBench bench;
  bench.run_planned(300);
  bench.link.stops.asked = true;
  bench.run(2);
  bench.link.stops.asked = false;
  bench.run(10);
  bench.link.stops.asked = true;
  bench.run(2);
  bench.link.stops.asked = false;
  bench.run_planned(2000);
  EXPECT_EQ(bench.departures(), 0U);
  EXPECT_NEAR(bench.cycle.status().position_set[0], 40, 1e-9);
}

TEST(Stop, ComesWhenAJogsTimeIsOverThoughNobodyNoticed) {
  StopBench bench;
  bench.run_planned(300);
  ServoWishes wishes;
  wishes.power = true;
  wishes.moves_until_s = bench.cycle.status().t_s + 0.05;
  bench.link.wishes.write(wishes);
  bench.run_planned(50);
  EXPECT_EQ(bench.departures(), 0U) << "its time is not over yet";
  bench.run_planned(4);
  EXPECT_EQ(bench.departures(), 1U);
  (void)bench.cycles_to_rest();
  EXPECT_LT(bench.cycle.status().position_set[0], 40);
}

TEST(Stop, ShowsThePoseThatTheJointsHaveBesideThePath) {
  StopBench bench;
  bench.run_planned(300);
  bench.link.stops.asked = true;
  (void)bench.cycles_to_rest();
  EXPECT_NEAR(bench.link.history.latest().pose_set.tip[0], bench.cycle.status().position_set[0], 1e-9);
}

TEST(Power, IsTakenOffForGood) {
  StopBench bench;
  bench.link.stops.power_off = true;
  bench.run(1);
  EXPECT_EQ(bench.cycle.status().state, ServoState::Off);
  bench.run(100);
  EXPECT_EQ(bench.cycle.status().state, ServoState::Off);
}

}  // namespace
}  // namespace rmac::gateway
