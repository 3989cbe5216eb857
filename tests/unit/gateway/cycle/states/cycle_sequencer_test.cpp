#include "gateway/cycle/states/cycle_sequencer.hpp"

#include <gmock/gmock.h>

#include <array>
#include <random>
#include <sstream>

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
    ASSERT_TRUE(cycle.phase().jogs());
    cycle.renew_jog(seen, 0.2);
  }
  seen.t_s += 0.201;
  EXPECT_EQ(cycle.step(seen).command, PathCommand::Stop);
  EXPECT_EQ(cycle.state(), CycleState::Stopping);
  EXPECT_FALSE(cycle.phase().jogs()) << "a renewal that comes too late does not take the stop back";
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
  const auto stop_now = [](CycleSequencer& cycle, CycleObservation& seen) { EXPECT_TRUE(cycle.stop_and_clear(seen)); };
  const auto time_passes = [](CycleSequencer&, CycleObservation& seen) { seen.t_s = 0.3; };
  EXPECT_EQ(cause_of(stop, {}), StopCause::CycleStop);
  EXPECT_EQ(cause_of(stop_now, {}), StopCause::StopNow);
  EXPECT_EQ(cause_of(stop, 0.2), StopCause::JogEnded);
  EXPECT_EQ(cause_of(time_passes, 0.2), StopCause::JogLapsed);
}

TEST(CycleSequencer, SaysThatACycleWithNothingToDoHasEndedWhateverEndsIt) {
  CycleSequencer cycle;
  CycleObservation seen;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  (void)cycle.step(seen);
  ASSERT_TRUE(cycle.stop_and_clear(seen));
  EXPECT_EQ(cycle.step(seen).came_to_rest, StopCause::CycleEnded);
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  seen.at_rest = false;       // it is not seen yet that the last move ended there
  ASSERT_TRUE(cycle.hold());  // as the end of a lease does first
  ASSERT_TRUE(cycle.stop_and_clear(seen));
  seen.at_rest = true;
  EXPECT_EQ(cycle.step(seen).came_to_rest, StopCause::CycleEnded);
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  seen.done = false;
  ASSERT_TRUE(cycle.stop_and_clear(seen));
  EXPECT_EQ(cycle.step(seen).came_to_rest, StopCause::StopNow) << "something was dropped";
}

// Red when a person is told that the machine is Running, and not why.
TEST(CycleSequencer, SaysThatTheCycleWaitsForMovesWhereItRefusesAJog) {
  CycleSequencer cycle;
  CycleObservation seen;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  EXPECT_THAT(cycle.start_positioning(seen, {}).error().message,
              testing::AllOf(testing::HasSubstr("waits for moves"), testing::HasSubstr("CycleStop")));
  seen.done = false;
  EXPECT_THAT(cycle.start_positioning(seen, {}).error().message, testing::HasSubstr("is Running"));
}

TEST(CycleSequencer, EndsACycleThatWaitsForMovesByAJogWhereThatIsConfigured) {
  CycleSequencer cycle(true);
  CycleObservation seen;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  seen.done = false;
  EXPECT_FALSE(cycle.start_positioning(seen, {})) << "a tool change is queued";
  seen.done = true;
  seen.at_rest = false;
  EXPECT_FALSE(cycle.start_positioning(seen, {})) << "it comes to rest behind its last move";
  seen.at_rest = true;
  cycle.end_waiting(seen);
  EXPECT_EQ(cycle.state(), CycleState::Idle);
  ASSERT_TRUE(cycle.start_positioning(seen, {}));
  EXPECT_TRUE(cycle.phase().positions());
}

TEST(CycleSequencer, NamesTheOperatorWhoHoldsToWhoeverStarts) {
  const auto panel = std::make_shared<Operator>("panel");
  CycleSequencer cycle;
  CycleObservation seen;
  seen.moves_left = 1;
  seen.done = false;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  ASSERT_TRUE(cycle.hold(panel));
  const auto refusals = [&] {
    return std::array{cycle.resume().error().message, cycle.start(sdk::CycleMode::Automatic, seen).error().message,
                      cycle.check_retrace(seen).error().message};
  };
  EXPECT_THAT(refusals(), testing::Each(testing::HasSubstr("panel, who is the operator, holds the machine")));
  panel->leave();
  EXPECT_THAT(refusals(), testing::Each(testing::HasSubstr("panel, who was the operator and has left")));
  ASSERT_TRUE(cycle.stop());
  (void)cycle.step(seen);
  EXPECT_THAT(cycle.start_positioning(seen, {}).error().message, testing::HasSubstr("panel"))
      << "a stop is no way round it";
  EXPECT_TRUE(cycle.resume(std::make_shared<Operator>("the next one"))) << "at rest it only lets go";
  EXPECT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
}

TEST(CycleSequencer, MakesNoProgramOfAMoveOutsideOfTheCycleThatIsHeld) {
  for (const auto lasts_s : {std::optional<double>(), std::optional(0.2)}) {
    CycleSequencer cycle;
    CycleObservation seen;
    seen.moves_left = 1;
    ASSERT_TRUE(cycle.start_positioning(seen, lasts_s));
    seen.at_rest = false;
    (void)cycle.step(seen);
    ASSERT_TRUE(cycle.hold());
    seen.at_rest = true;
    (void)cycle.step(seen);
    const auto started = cycle.start(sdk::CycleMode::Automatic, seen);
    ASSERT_FALSE(started);
    EXPECT_THAT(started.error().message, testing::HasSubstr("a jog is held"));
    ASSERT_TRUE(cycle.stop());
    EXPECT_TRUE(cycle.step(seen).clear_queue) << "what is left of it must not run at the next start";
    EXPECT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  }
}

TEST(CycleSequencer, LetsAJogThatWasHeldLapse) {
  CycleSequencer cycle;
  CycleObservation seen;
  seen.moves_left = 1;
  ASSERT_TRUE(cycle.start_positioning(seen, 0.2));
  seen.at_rest = false;
  (void)cycle.step(seen);
  ASSERT_TRUE(cycle.hold());
  seen.at_rest = true;
  seen.t_s = 1;
  (void)cycle.step(seen);
  ASSERT_TRUE(cycle.resume());
  const auto verdict = cycle.step(seen);
  EXPECT_EQ(verdict.came_to_rest, StopCause::JogLapsed) << "nobody renewed it";
  EXPECT_TRUE(verdict.clear_queue) << "what is left of a jog must not run at the next start";
}

TEST(CycleSequencer, TakesNoRetraceWhileASearchIsStillToBeDropped) {
  CycleSequencer cycle;
  CycleObservation seen;
  seen.at_rest = false;
  ASSERT_TRUE(cycle.start(sdk::CycleMode::Automatic, seen));
  cycle.touched();
  ASSERT_TRUE(cycle.hold());
  seen.at_rest = true;
  EXPECT_FALSE(cycle.check_retrace(seen));
  EXPECT_TRUE(cycle.step(seen).clear_queue);
  EXPECT_TRUE(cycle.check_retrace(seen));
}

/// Commands and observations at random; what must hold whatever comes.
class RandomCycle {
 public:
  explicit RandomCycle(unsigned seed) : random_(seed) {}

  void step() {
    observe();
    const CycleState before = cycle_.state();
    const OperatorRef held_before = cycle_.phase().held_by();
    const int command = pick(20);
    act(command);
    check_hold(held_before, command);
    trace_ << ' ' << command;
    const bool reset = before != cycle_.state() && cycle_.state() == CycleState::Idle && is_faulted(before);
    if (is_faulted(before)) {
      EXPECT_TRUE(reset || is_faulted(cycle_.state())) << "a fault is left by a reset alone";
    }
    if (is_faulted(cycle_.state())) {
      EXPECT_FALSE(cycle_.phase().positions() || cycle_.phase().empties_queue());
    }
    const bool stopping = cycle_.state() == CycleState::Stopping;
    const bool emptying = cycle_.phase().empties_queue();
    const auto verdict = cycle_.step(seen_);
    if (verdict.command) planner_ = *verdict.command;
    check(verdict, stopping, emptying);
  }
  [[nodiscard]] std::string trace() const { return trace_.str(); }

 private:
  int pick(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  bool once_in(int count) { return pick(count) == 0; }

  void observe() {
    seen_.t_s += 0.01 * pick(8);
    if (once_in(3)) seen_.at_rest = !seen_.at_rest;
    seen_.moves_left = static_cast<std::size_t>(pick(3));
    if (once_in(6)) ++seen_.moves_done;
    seen_.faulted = once_in(50);
    seen_.emergency_stop = seen_.faulted && once_in(2);
    if (once_in(8)) seen_.spindles_at_speed = !seen_.spindles_at_speed;
    if (once_in(10)) seen_.follows = !seen_.follows;
    if (once_in(20)) ++seen_.homings;
    seen_.air = !once_in(40);
    seen_.measures = once_in(10);
    seen_.retraced = seen_.at_rest && once_in(3);
  }

  void act(int command) {
    switch (command) {
      case 0:
      case 1:
        (void)cycle_.start(command == 0 ? sdk::CycleMode::Automatic : sdk::CycleMode::Manual, seen_);
        break;
      case 2:
        (void)cycle_.start_positioning(seen_, std::nullopt);
        break;
      case 3:
        (void)cycle_.start_positioning(seen_, kJogLasts_s);
        break;
      case 4:
        cycle_.renew_jog(seen_, kJogLasts_s);
        break;
      case 5:
        (void)cycle_.start_homing(seen_);
        break;
      case 6:
        if (cycle_.check_retrace(seen_)) cycle_.retrace();
        break;
      case 7:
        (void)cycle_.stop();
        break;
      case 8:
        (void)cycle_.stop_and_clear(seen_);
        break;
      case 9:
        cycle_.touched();
        break;
      case 10:
        (void)cycle_.hold();
        break;
      case 11:
        (void)cycle_.resume();
        break;
      case 12:
        if (cycle_.reset()) planner_ = PathCommand::Stop;
        break;
      case 13:
        cycle_.spindle_commanded(0.1);
        break;
      case 14:
        cycle_.mechanism_changed(once_in(2));
        planner_ = PathCommand::Stop;
        break;
      case kOperatorHolds:
        (void)cycle_.hold(panel_);
        break;
      case kOperatorResumes:
        (void)cycle_.resume(panel_);
        break;
      case kOperatorRunsBack:
        if (cycle_.check_retrace(seen_, panel_)) cycle_.retrace(panel_);
        break;
      case kLetGo:
        cycle_.let_go();
        break;
      default:
        cycle_.one_done();
        break;
    }
  }

  /// What an operator holds stays held whatever a program commands; then nothing but an operator's way back runs.
  void check_hold(const OperatorRef& before, int command) const {
    if (before && command != kOperatorResumes && command != kLetGo) {
      EXPECT_EQ(cycle_.phase().held_by(), panel_);
    }
    if (command == kOperatorHolds) {
      EXPECT_EQ(cycle_.phase().held_by(), panel_);
      EXPECT_NE(cycle_.state(), CycleState::Running);
    }
  }

  void check(const CycleSequencer::Verdict& verdict, bool was_stopping, bool was_emptying) {
    const CycleState state = cycle_.state();
    if (verdict.clear_queue) {
      EXPECT_TRUE(seen_.at_rest) << "only at rest can a queue be emptied";
    }
    if (was_stopping && seen_.at_rest && !seen_.faulted) {
      EXPECT_EQ(state, CycleState::Idle);
      EXPECT_TRUE(verdict.came_to_rest) << "a stop says why it was";
      if (was_emptying) {
        EXPECT_TRUE(verdict.clear_queue);
      }
    }
    if (was_stopping && !seen_.at_rest && !seen_.faulted) {
      EXPECT_EQ(state, CycleState::Stopping);
    }
    if (cycle_.phase().held_by()) {
      EXPECT_TRUE(planner_ == PathCommand::Stop || planner_ == PathCommand::Retrace);
      EXPECT_FALSE(cycle_.phase().jogs() || cycle_.phase().homes());
    }
    if (state != CycleState::Running) {
      EXPECT_EQ(planner_, PathCommand::Stop) << "nothing but a running cycle moves";
      EXPECT_FALSE(cycle_.phase().jogs() || cycle_.phase().homes());
    }
    if (state == CycleState::Idle) {
      EXPECT_FALSE(cycle_.phase().positions());
    }
    EXPECT_TRUE(!cycle_.phase().empties_queue() || state == CycleState::Stopping);
    if (cycle_.phase().homes()) {
      EXPECT_EQ(planner_, PathCommand::Stop) << "the drives move, no path does";
    }
    if (cycle_.phase().jogs() || cycle_.phase().homes()) {
      EXPECT_TRUE(cycle_.phase().positions());
    }
    if (seen_.faulted) {
      EXPECT_TRUE(is_faulted(state));
    }
    if (!seen_.air) {
      EXPECT_NE(state, CycleState::Running);
    }
    if (planner_ == PathCommand::Retrace) {
      EXPECT_FALSE(cycle_.phase().positions());
    }
  }

  static constexpr double kJogLasts_s = 0.2;
  static constexpr int kOperatorHolds = 16, kOperatorResumes = 17, kOperatorRunsBack = 18, kLetGo = 19;
  const OperatorRef panel_ = std::make_shared<Operator>("panel");
  std::mt19937 random_;
  std::ostringstream trace_;
  CycleObservation seen_;
  CycleSequencer cycle_;
  PathCommand planner_ = PathCommand::Stop;
};

TEST(CycleSequencer, KeepsItsPromisesWhateverIsCommandedAndSeen) {
  for (unsigned seed = 1; seed <= 3000 && !testing::Test::HasFailure(); ++seed) {
    RandomCycle cycle(seed);
    for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) cycle.step();
    EXPECT_FALSE(testing::Test::HasFailure()) << "seed " << seed << ", commands" << cycle.trace();
  }
}

}  // namespace
}  // namespace rmac::gateway
