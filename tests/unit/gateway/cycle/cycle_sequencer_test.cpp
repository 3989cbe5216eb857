#include "gateway/cycle/cycle_sequencer.hpp"

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

// Red when a CycleStart that is repeated starts anew: the wait for the spindle would never end.
TEST(CycleSequencer, WaitsNoLongerForASpindleWhenCycleStartIsRepeated) {
  CycleSequencer cycle;
  CycleObservation seen;
  seen.moves_left = 1;
  seen.spindles_at_speed = false;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  cycle.spindle_commanded(2.0);
  for (; seen.t_s < 1.9; seen.t_s += 0.5) {
    EXPECT_FALSE(cycle.step(seen).spindle_timed_out);
    ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  }
  seen.t_s = 2.1;
  EXPECT_TRUE(cycle.step(seen).spindle_timed_out);
}

// Red when a CycleStart that is repeated starts anew: the move that ends meanwhile would not count as the one.
TEST(CycleSequencer, RunsNoSecondMoveInManualModeWhenCycleStartIsRepeated) {
  CycleSequencer cycle;
  CycleObservation seen;
  seen.moves_left = 2;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Manual, seen));
  EXPECT_EQ(cycle.step(seen).command, PathCommand::RunOne);
  seen.at_rest = false;
  seen.moves_left = 1;
  seen.moves_done = 1;
  (void)cycle.step(seen);
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Manual, seen));
  seen.at_rest = true;
  EXPECT_EQ(cycle.step(seen).came_to_rest, StopCause::MoveDone);
  EXPECT_EQ(cycle.state(), CycleState::Idle);
}

TEST(CycleSequencer, RunsAJogOnlyWhileItIsRenewed) {
  CycleSequencer cycle;
  CycleObservation seen;
  ASSERT_TRUE(cycle.start_positioning(seen, 0.2));
  seen.at_rest = false;
  seen.moves_left = 1;
  for (int renewal = 0; renewal < 50; ++renewal) {
    seen.t_s += 0.19;
    EXPECT_TRUE(cycle.step(seen).command || renewal > 0);
    ASSERT_TRUE(cycle.jogs());
    cycle.renew_jog(seen, 0.2);
  }
  seen.t_s += 0.201;
  EXPECT_EQ(cycle.step(seen).command, PathCommand::Stop);
  EXPECT_EQ(cycle.state(), CycleState::Stopping);
  EXPECT_FALSE(cycle.jogs()) << "a renewal that comes too late does not take the stop back";
  seen.at_rest = true;
  EXPECT_TRUE(cycle.step(seen).clear_queue);
  EXPECT_EQ(cycle.state(), CycleState::Idle);
}

TEST(CycleSequencer, HoldsAgainAtTheEndOfARetraceInEitherMode) {
  for (const auto mode : {sdk::CycleMode::Automatic, sdk::CycleMode::Manual}) {
    CycleSequencer cycle;
    CycleObservation seen;
    seen.moves_left = 2;
    ASSERT_TRUE(cycle.start(mode, seen));
    seen.moves_done = 1;
    seen.at_rest = false;
    (void)cycle.step(seen);
    ASSERT_TRUE(cycle.hold());
    EXPECT_FALSE(cycle.check_retrace(seen)) << "not at rest yet";
    seen.at_rest = true;
    (void)cycle.step(seen);
    ASSERT_TRUE(cycle.check_retrace(seen));
    cycle.retrace();
    EXPECT_EQ(cycle.step(seen).command, PathCommand::Retrace);
    EXPECT_EQ(cycle.state(), CycleState::Running);
    EXPECT_FALSE(cycle.start(mode, seen));
    seen.retraced = true;
    EXPECT_EQ(cycle.step(seen).came_to_rest, StopCause::RetraceEnded);
    EXPECT_EQ(cycle.state(), CycleState::Holding);
  }
}

TEST(CycleSequencer, SaysWhyTheMachineCameToRest) {
  const auto cause_of = [](const auto& stop, std::optional<double> jog_lasts_s) {
    CycleSequencer cycle;
    CycleObservation seen;
    seen.moves_left = 1;
    EXPECT_TRUE(jog_lasts_s ? cycle.start_positioning(seen, *jog_lasts_s)
                            : cycle.start(sdk::CycleMode::Automatic, seen));
    seen.at_rest = false;
    (void)cycle.step(seen);
    stop(cycle, seen);
    EXPECT_EQ(cycle.step(seen).came_to_rest, std::nullopt) << "still moving";
    seen.at_rest = true;
    return cycle.step(seen).came_to_rest;
  };
  const auto stop = [](CycleSequencer& cycle, CycleObservation&) { EXPECT_TRUE(cycle.stop()); };
  const auto stop_now = [](CycleSequencer& cycle, CycleObservation&) { EXPECT_TRUE(cycle.stop_and_clear()); };
  const auto time_passes = [](CycleSequencer&, CycleObservation& seen) { seen.t_s = 0.3; };
  EXPECT_EQ(cause_of(stop, {}), StopCause::CycleStop);
  EXPECT_EQ(cause_of(stop_now, {}), StopCause::StopNow);
  EXPECT_EQ(cause_of(stop, 0.2), StopCause::JogEnded);
  EXPECT_EQ(cause_of(time_passes, 0.2), StopCause::JogLapsed);
}

}  // namespace
}  // namespace rmac::gateway
