// A step of the planner ends early while somebody waits to command something, and nothing is lost by it.
#include "rmac/motion/interruption.hpp"

#include <gtest/gtest.h>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

using test::kUp;

class Interrupted : public ::testing::Test {
 protected:
  Interrupted() : bench(test::mill()) {
    bench.planner.give_way_to(&interruption);
    Move move;
    move.id = 1;
    move.feed_mm_s = 100;
    move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{45, 10, 0}, kUp}};
    EXPECT_TRUE(bench.queue(move));
    bench.planner.command(PathCommand::Run);
  }
  /// Whether one of so many steps published a plan.
  bool publishes(int steps) {
    for (int i = 0; i < steps; ++i) {
      if (bench.planner.step(bench.progress())) return true;
    }
    return false;
  }

  Interruption interruption;
  test::PlannerBench bench;
};

TEST_F(Interrupted, StepFindsNoPlanAndGoesOnOnceNobodyWaits) {
  {
    const Interruption::Request urgent(interruption);
    EXPECT_FALSE(publishes(20));
    EXPECT_FALSE(bench.planner.idle(bench.progress())) << "it is still to be done, at once";
    const Interruption::Request another(interruption);
  }
  EXPECT_FALSE(interruption.wanted());
  EXPECT_TRUE(publishes(3));
  EXPECT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), 1U);
}

TEST_F(Interrupted, HoldIsAnsweredAllTheSame) {
  while (bench.record.empty() || bench.record.back().feed_mm_s < 90) bench.cycle();
  bench.planner.command(PathCommand::Stop);
  const Interruption::Request urgent(interruption);
  EXPECT_TRUE(publishes(1));
}

}  // namespace
}  // namespace rmac
