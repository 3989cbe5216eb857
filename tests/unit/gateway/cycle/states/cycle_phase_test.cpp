#include "gateway/cycle/states/cycle_phase.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

using Phase = CyclePhase;

Phase running(const auto& what) {
  Phase phase;
  phase.run(what);
  return phase;
}

TEST(CyclePhase, HoldsAndResumesWhatRan) {
  Phase jog = running(Phase::Jog{3.5});
  jog.hold();
  EXPECT_EQ(jog.state(), CycleState::Holding);
  EXPECT_TRUE(jog.positions());
  jog.resume();
  ASSERT_NE(jog.runs<Phase::Jog>(), nullptr);
  EXPECT_EQ(jog.runs<Phase::Jog>()->until_s, 3.5) << "a held jog is not renewed";
  Phase positioning = running(Phase::Positioning{});
  positioning.hold();
  positioning.resume();
  EXPECT_NE(positioning.runs<Phase::Positioning>(), nullptr);
}

TEST(CyclePhase, HoldsNoHomingAndNoRetrace) {
  Phase homing = running(Phase::Homing{4});
  homing.hold();
  EXPECT_EQ(homing.state(), CycleState::Stopping);
  Phase retrace = running(Phase::Retrace{});
  retrace.hold();
  retrace.resume();
  EXPECT_NE(retrace.runs<Phase::Program>(), nullptr) << "held, it goes forward again";
}

TEST(CyclePhase, KeepsAnOperatorsHoldThroughStopsFaultsAndRest) {
  const auto panel = std::make_shared<Operator>("panel");
  Phase phase = running(Phase::Program{});
  phase.hold_for(panel);
  EXPECT_EQ(phase.state(), CycleState::Holding);
  phase.stop_and_clear(StopCause::StopNow);
  EXPECT_TRUE(phase.empties_queue()) << "a stop is a stop";
  EXPECT_EQ(phase.held_by(), panel);
  phase.rest();
  EXPECT_EQ(phase.state(), CycleState::Idle);
  EXPECT_EQ(phase.held_by(), panel);
  phase.fault(true);
  EXPECT_EQ(phase.held_by(), panel);
  phase.rest();
  EXPECT_TRUE(phase.let_go());
  EXPECT_EQ(phase.held_by(), nullptr);
  EXPECT_FALSE(phase.let_go());
}

TEST(CyclePhase, KeepsAnOperatorsHoldOverAWayBack) {
  const auto panel = std::make_shared<Operator>("panel");
  for (const auto end : {+[](Phase& phase) { phase.hold(); }, +[](Phase& phase) { phase.hold_program(); },
                         +[](Phase& phase) { phase.touch(); }, +[](Phase& phase) { phase.stop(StopCause::AirLost); },
                         +[](Phase& phase) { phase.fault(false); }}) {
    Phase back = running(Phase::Retrace{panel});
    EXPECT_EQ(back.held_by(), panel);
    end(back);
    EXPECT_EQ(back.held_by(), panel);
  }
  Phase back = running(Phase::Retrace{panel});
  EXPECT_TRUE(back.let_go());
  EXPECT_NE(back.runs<Phase::Retrace>(), nullptr) << "nothing stops by it";
}

TEST(CyclePhase, HoldsForAnOperatorWhateverItDoes) {
  const auto panel = std::make_shared<Operator>("panel");
  for (Phase phase : {Phase(), running(Phase::Program{}), running(Phase::Jog{1}), running(Phase::Positioning{}),
                      running(Phase::Homing{1}), running(Phase::Retrace{})}) {
    phase.hold_for(panel);
    EXPECT_NE(phase.state(), CycleState::Running);
    EXPECT_EQ(phase.held_by(), panel);
  }
}

TEST(CyclePhase, EmptiesTheQueueAfterAJogWhateverStoppedIt) {
  for (const StopCause cause : {StopCause::CycleStop, StopCause::AirLost, StopCause::JogEnded}) {
    Phase jog = running(Phase::Jog{});
    jog.stop(cause);
    EXPECT_TRUE(jog.empties_queue());
    EXPECT_TRUE(jog.positions()) << "it is coming to rest";
    Phase program = running(Phase::Program{});
    program.stop(cause);
    EXPECT_FALSE(program.empties_queue());
    EXPECT_FALSE(program.positions());
  }
}

TEST(CyclePhase, EndsASearchInWhateverStateTheProbeTouches) {
  Phase program = running(Phase::Program{});
  program.touch();
  EXPECT_TRUE(program.ends_search());
  EXPECT_EQ(program.state(), CycleState::Running) << "the cycle goes on with what is queued then";
  program.hold();
  EXPECT_TRUE(program.ends_search());
  program.resume();
  EXPECT_TRUE(program.ends_search());
  program.stop(StopCause::CycleStop);
  EXPECT_TRUE(program.ends_search());
  EXPECT_FALSE(program.empties_queue()) << "the measurement is not given up";
  program.forget_search();
  EXPECT_EQ(program.state(), CycleState::Stopping);
  EXPECT_FALSE(program.ends_search());
  Phase stopping = running(Phase::Program{});
  stopping.stop(StopCause::AirLost);
  stopping.touch();
  EXPECT_TRUE(stopping.ends_search());
  EXPECT_EQ(stopping.in<Phase::Stopping>()->cause, StopCause::AirLost);
}

TEST(CyclePhase, HoldsWhereTheProbeTouchesOnTheWayBack) {
  Phase retrace = running(Phase::Retrace{});
  retrace.touch();
  EXPECT_EQ(retrace.state(), CycleState::Holding);
  EXPECT_TRUE(retrace.ends_search());
}

TEST(CyclePhase, EndsAJogWhereTheProbeTouches) {
  Phase jog = running(Phase::Jog{1});
  jog.touch();
  ASSERT_NE(jog.in<Phase::Stopping>(), nullptr);
  EXPECT_EQ(jog.in<Phase::Stopping>()->cause, StopCause::HitByHand);
  EXPECT_TRUE(jog.empties_queue());
}

TEST(CyclePhase, TakesAnEmergencyStopForMoreThanAFault) {
  Phase phase;
  phase.fault(false);
  EXPECT_EQ(phase.state(), CycleState::Faulted);
  phase.fault(true);
  EXPECT_EQ(phase.state(), CycleState::EmergencyStop);
  phase.fault(false);
  EXPECT_EQ(phase.state(), CycleState::EmergencyStop);
  phase.stop_and_clear(StopCause::StopNow);
  EXPECT_EQ(phase.state(), CycleState::EmergencyStop) << "left by a reset alone";
}

}  // namespace
}  // namespace rmac::gateway
