#include "gateway/controller/cycle_sequencer.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

TEST(CycleSequencer, KeepsAFaultWhenTheMechanismIsTakenOut) {
  CycleSequencer cycle;
  cycle.fault();
  cycle.mechanism_changed(false);
  EXPECT_EQ(cycle.state(), CycleState::Faulted);
  ASSERT_TRUE(cycle.reset());
  EXPECT_EQ(cycle.state(), CycleState::Idle);
}

TEST(CycleSequencer, WaitsForASpindleOnlyWhileNothingMoves) {
  CycleSequencer cycle;
  CycleObservation seen;
  seen.moves_left = 1;
  seen.at_rest = false;
  seen.spindles_at_speed = false;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  cycle.spindle_commanded(2.0);  // in mid-cut
  for (seen.t_s = 0; seen.t_s < 10; seen.t_s += 0.5) EXPECT_FALSE(cycle.step(seen).spindle_timed_out);
  EXPECT_EQ(cycle.state(), CycleState::Running);
  seen.at_rest = true;
  EXPECT_FALSE(cycle.step(seen).spindle_timed_out);
  seen.t_s += 2.5;
  EXPECT_TRUE(cycle.step(seen).spindle_timed_out);
  EXPECT_EQ(cycle.state(), CycleState::Faulted);
}

}  // namespace
}  // namespace rmac::gateway
