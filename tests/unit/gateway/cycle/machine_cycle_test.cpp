#include "gateway/cycle/machine_cycle.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;
using Pace = Planning::Pace;

class MachineCycleRuns : public testing::Test {
 protected:
  void add_tool_change(std::vector<QueueStep> steps) {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.queue.add_steps(std::move(steps), step_at(bench_.cycle.builder(), 4));
  }
  [[nodiscard]] Expected<> require_rest() {
    const GatewayTurn turn(bench_.cycle.lock);
    return bench_.cycle.require_rest("this");
  }
  CycleBench bench_;
};

TEST_F(MachineCycleRuns, WhatIsQueuedOnceStarted) {
  ASSERT_TRUE(bench_.queue(1, 5));
  bench_.run(50);
  EXPECT_EQ(bench_.x(), 0) << "nothing moves before the start";
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
  EXPECT_EQ(bench_.state(), CycleState::Running) << "the cycle waits for more";
}

TEST_F(MachineCycleRuns, AMoveThatIsQueuedBehindAToolChangeWithTheNewTool) {
  ASSERT_TRUE(bench_.queue(1, 5));
  add_tool_change({BeginToolChange{}, AskPerson{"insert T4"}, MountTool{.number = 4, .text = "T4"}});
  ASSERT_TRUE(bench_.queue(2, 9));
  ASSERT_TRUE(bench_.start());
  bench_.run(2000);
  EXPECT_NEAR(bench_.x(), 5, 1e-9);
  EXPECT_EQ(bench_.step(), Pace::Calm) << "a person takes a while";
  EXPECT_EQ(bench_.told(Event::Kind::ToolWanted), "insert T4");
  {
    const GatewayTurn turn(bench_.cycle.lock);
    ASSERT_TRUE(bench_.cycle.tools.confirm(4, bench_.cycle.queue.steps(), CycleState::Running));
    bench_.cycle.queue.step_done();
    bench_.cycle.take_steps(bench_.cycle.status());
  }
  EXPECT_EQ(bench_.told(Event::Kind::ToolChanged), "T4 is in the spindle");
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), 9, 1e-9);
}

TEST_F(MachineCycleRuns, NoToolStepBeforeTheMovesAheadOfItAreDone) {
  ASSERT_TRUE(bench_.queue(1, 5));
  add_tool_change({SwitchOutputs{.mask = 1, .values = 1}, MountTool{.number = 4}});
  ASSERT_TRUE(bench_.start());
  bench_.run(20);
  ASSERT_GT(bench_.x(), 0);
  EXPECT_EQ(bench_.wishes().outputs, 0U);
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_EQ(bench_.wishes().outputs, 1U);
}

TEST_F(MachineCycleRuns, IntoAFaultWhenAnInputOfTheToolChangerDoesNotCome) {
  add_tool_change({AwaitInput{.bit = 2, .on = true, .timeout_s = 0.5, .name = "Clamped"}, MountTool{.number = 4}});
  ASSERT_TRUE(bench_.start());
  bench_.run(450);
  EXPECT_EQ(bench_.state(), CycleState::Running);
  bench_.run(100);
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_THAT(bench_.told(Event::Kind::Fault), HasSubstr("input Clamped"));
}

TEST_F(MachineCycleRuns, NoSpindleAndNoOutputInAnEmergencyStop) {
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) {
      wish.spindle_rpm[0] = 100;
      wish.outputs = 3;
    });
  }
  bench_.status.state = ServoState::Faulted;
  bench_.status.fault.kind = ServoFault::Kind::FollowingError;
  bench_.step();
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_EQ(bench_.wishes().spindle_rpm[0], 0);
  EXPECT_EQ(bench_.wishes().outputs, 3U) << "a fault leaves the outputs";
  bench_.status.fault.kind = ServoFault::Kind::EmergencyStop;
  bench_.step();
  EXPECT_EQ(bench_.state(), CycleState::EmergencyStop);
  EXPECT_EQ(bench_.wishes().outputs, 0U);
  EXPECT_FALSE(bench_.queue(1, 5));
}

TEST_F(MachineCycleRuns, NoMoveBeforeTheSpindleIsAtSpeedAndTellsWhichWasNot) {
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) { wish.spindle_rpm[0] = 500; });
    bench_.cycle.await_spindles();
  }
  ASSERT_TRUE(bench_.queue(1, 5));
  ASSERT_TRUE(bench_.start());
  bench_.run(100);
  EXPECT_EQ(bench_.x(), 0);
  bench_.status.spindle_rpm[0] = 490;
  bench_.run(100);
  EXPECT_GT(bench_.x(), 0) << "within its tolerance";
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  bench_.status.spindle_rpm[0] = 400;
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.await_spindles();
  }
  bench_.run(5100);
  EXPECT_EQ(bench_.state(), CycleState::Faulted);
  EXPECT_THAT(bench_.told(Event::Kind::Fault), HasSubstr("spindle 0 turns at 400 of 500 rpm"));
}

TEST_F(MachineCycleRuns, NoMoveWhileNobodyKnowsTheSpindlesSpeed) {
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.wishes.change([](ServoWishes& wish) { wish.spindle_rpm[0] = 500; });
    bench_.cycle.await_spindles();
  }
  bench_.status.generation = 0;  // the servo loop has not told of this mechanism yet
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.settle(bench_.status);
    EXPECT_TRUE(bench_.cycle.sequencer.waits_for_spindle());
  }
}

TEST_F(MachineCycleRuns, TheQueueEmptyWhenItIsStoppedNowAndTheNextMoveFromWhereItStands) {
  ASSERT_TRUE(bench_.queue(1, 30));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 10; }));
  ASSERT_TRUE(bench_.stop_now());
  const auto refused = bench_.queue(2, 0);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("the queue is being emptied"));
  ASSERT_TRUE(bench_.run_to_rest());
  EXPECT_EQ(bench_.moves_left(), 0U);
  const double stands = bench_.x();
  EXPECT_LT(stands, 30);
  ASSERT_TRUE(bench_.queue(2, stands + 2));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), stands + 2, 1e-9);
}

TEST_F(MachineCycleRuns, NothingThatNeedsRestWhileItMovesOrHasMovesToDo) {
  EXPECT_TRUE(require_rest());
  ASSERT_TRUE(bench_.queue(1, 30));
  EXPECT_THAT(require_rest().error().message, HasSubstr("1 moves are still in it"));
  ASSERT_TRUE(bench_.start());
  bench_.run(50);
  EXPECT_THAT(require_rest().error().message, HasSubstr("it is moving"));
}

TEST_F(MachineCycleRuns, NothingOfAGenerationThatIsNotInForce) {
  ASSERT_TRUE(bench_.queue(1, 5));
  ASSERT_TRUE(bench_.start());
  bench_.status.generation = 7;
  EXPECT_EQ(bench_.step(), Pace::Calm);
  bench_.run(50);
  EXPECT_EQ(bench_.x(), 0);
}

TEST(MachineCycleWithoutAMechanism, TakesNoMoveAndNeedsNoRest) {
  ServoLink link(1);
  MachineCycle cycle({}, link);
  const GatewayTurn turn(cycle.lock);
  EXPECT_FALSE(cycle.ready_for_move());
  EXPECT_TRUE(cycle.require_rest("this"));
  EXPECT_EQ(cycle.moves_left(), 0U);
  EXPECT_EQ(cycle.advance(cycle.status()), Pace::Calm);
}

TEST(MachineCycleQueue, TakesNoMoreThanItsCapacity) {
  ServoLink link(1);
  MachineCycle cycle({.queue_capacity = 2}, link);
  const auto mechanism = CycleBench::make_mechanism(false);
  ServoStatus status;
  status.generation = 1;
  status.follows = true;
  status.joint_count = 3;
  link.status.write(status);
  {
    const GatewayTurn turn(cycle.lock);
    (void)cycle.install(mechanism, 1, false);
  }
  MoveEntry entry(cycle);
  for (int id = 1; id <= 2; ++id) {
    ASSERT_TRUE(entry.prepare());
    ASSERT_TRUE(entry.add(CycleBench::move_to(id, id)));
  }
  const auto full = entry.prepare();
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, MinorCode::CommandQueueFull);
}

}  // namespace
}  // namespace rmac::gateway
