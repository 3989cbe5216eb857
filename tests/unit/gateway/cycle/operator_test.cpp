// What the operator does beside a program, on a machine that moves.
#include "gateway/state/operator.hpp"

#include <gmock/gmock.h>

#include <array>
#include <functional>
#include <random>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// A mill in the midst of a long line along X.
class BesideAProgram : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(cam().path().set_feedrate(120));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {45, 0, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until([&] { return x() > 1; }));
  }
  void hold() {
    ASSERT_TRUE(operating().hold(panel_));
    ASSERT_TRUE(machine_.run_until([&] { return !machine_.controller.sample().moving; }));
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  OperatorPort& operating() { return machine_.controller.operating(); }
  [[nodiscard]] CycleNow now() const { return machine_.controller.cycle_now(); }
  [[nodiscard]] double x() const { return machine_.controller.sample().position_set[0]; }
  /// Some cycles go by.
  void wait() {
    const auto begin = machine_.controller.sample().cycle;
    ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().cycle > begin + 100; }));
  }
  TestMachine machine_;
  std::shared_ptr<Operator> panel_ = std::make_shared<Operator>("panel");
};

TEST_F(BesideAProgram, HoldsAndResumesIt) {
  hold();
  EXPECT_EQ(now().state, CycleState::Holding);
  EXPECT_EQ(now().held_by, "panel");
  const double held = x();
  ASSERT_TRUE(operating().resume(panel_));
  EXPECT_EQ(now().held_by, "");
  EXPECT_TRUE(machine_.run_until([&] { return x() > held + 0.1; }));
}

// Red when any command of the program's client, or several in a row, moves a machine that the operator holds.
TEST_F(BesideAProgram, KeepsTheMachineHeldWhateverTheProgramDoes) {
  hold();
  const double held = x();
  const std::array<std::function<void()>, 9> commands{[&] { (void)cam().cycle().resume(); },
                                                      [&] { (void)cam().cycle().start(sdk::CycleMode::Automatic); },
                                                      [&] { (void)cam().cycle().start(sdk::CycleMode::Manual); },
                                                      [&] { (void)cam().cycle().stop(); },
                                                      [&] { (void)cam().cycle().stop_now(); },
                                                      [&] { (void)cam().cycle().hold(); },
                                                      [&] { (void)cam().cycle().retrace(1); },
                                                      [&] { (void)cam().parking().park(); },
                                                      [&] { (void)cam().positioning().jog_joint(1, 5); }};
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const std::size_t command = random() % commands.size();
    commands[command]();
    if (i % 4 == 0) wait();
    ASSERT_EQ(now().held_by, "panel") << "command " << command;
    ASSERT_NE(now().state, CycleState::Running) << "command " << command;
  }
  wait();
  EXPECT_EQ(x(), held);
  EXPECT_EQ(machine_.controller.sample().position_set[1], 0);
}

// Red when a spindle starts beside a person who holds the machine.
TEST_F(BesideAProgram, KeepsSpindlesOffButLetsThemBeStopped) {
  hold();
  EXPECT_THAT(cam().spindles().set_rpm(0, 100).error().message, HasSubstr("SetSpindleRPM: panel"));
  EXPECT_TRUE(cam().spindles().set_rpm(0, 0));
  ASSERT_TRUE(operating().resume(panel_));
  EXPECT_TRUE(cam().spindles().set_rpm(0, 100));
}

// Red when a clamp opens, or a laser goes on, under the hands of a person who holds the machine.
TEST_F(BesideAProgram, SwitchesNothingWhileTheyHold) {
  hold();
  for (const bool on : {true, false})
    EXPECT_THAT(cam().spindles().set_output("Coolant", on).error().message, HasSubstr("SetOutput: panel"));
  EXPECT_THAT(cam().spindles().set_coolant(true).error().message, HasSubstr("TurnCoolantOn: panel"));
  EXPECT_TRUE(cam().spindles().set_coolant(false));
  ASSERT_TRUE(operating().resume(panel_));
  EXPECT_TRUE(cam().spindles().set_output("Coolant", true));
}

TEST_F(BesideAProgram, LeavesTheHoldWhenTheyGoToTheNextOperator) {
  hold();
  panel_->leave();
  EXPECT_THAT(cam().cycle().resume().error().message, HasSubstr("panel, who was the operator and has left"));
  const double held = x();
  ASSERT_TRUE(operating().resume(std::make_shared<Operator>("the next one")));
  EXPECT_TRUE(machine_.run_until([&] { return x() > held + 0.1; }));
}

TEST_F(BesideAProgram, LeavesTheHoldToTheProgramAfterAResetOnceTheyHaveLeft) {
  hold();
  EXPECT_THAT(cam().cycle().reset().error().message, HasSubstr("panel, who is the operator, holds the machine"));
  panel_->leave();
  ASSERT_TRUE(cam().cycle().reset());
  EXPECT_EQ(now().state, CycleState::Holding) << "nothing moves by it";
  const double held = x();
  ASSERT_TRUE(cam().cycle().resume());
  EXPECT_TRUE(machine_.run_until([&] { return x() > held + 0.1; }));
}

// Red when who takes over what one operator left takes from another what that one holds.
TEST_F(BesideAProgram, LeavesNothingToTheProgramThatAnOperatorWhoIsThereHolds) {
  hold();
  panel_->leave();
  const auto next = std::make_shared<Operator>("the next one");
  ASSERT_TRUE(operating().set_feed_override(0, next));
  EXPECT_THAT(cam().cycle().reset().error().message, HasSubstr("the next one, who is the operator"));
  EXPECT_EQ(now().held_by, "panel");
}

TEST_F(BesideAProgram, RunsItBackAndStillHoldsIt) {
  hold();
  const double held = x();
  const auto way = operating().retrace(0.5, panel_);
  ASSERT_TRUE(way) << way.error().message;
  panel_->leave();  // in the midst of it
  ASSERT_TRUE(machine_.run_until([&] { return now().state == CycleState::Holding; }));
  EXPECT_NEAR(x(), held - 0.5, 1e-6);
  EXPECT_FALSE(cam().cycle().resume());
}

TEST_F(BesideAProgram, KeepsAnOverrideOfZeroFromTheProgramAndFromAnotherMachine) {
  ASSERT_TRUE(operating().set_feed_override(0, panel_));
  EXPECT_EQ(now().held_by, "panel");
  EXPECT_STREQ(now().waits_for, "override");
  EXPECT_FALSE(cam().cycle().set_feed_override(100));
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().state == CycleState::Idle; }));
  ASSERT_TRUE(machine_.load(TestMachine::plane_mill()));
  EXPECT_EQ(now().override_percent, 0) << "another mechanism has 100 %, but for this";
  panel_->leave();
  ASSERT_TRUE(cam().cycle().reset());
  EXPECT_TRUE(cam().cycle().set_feed_override(100));
}

TEST_F(BesideAProgram, HidesNoStop) {
  hold();
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().state == CycleState::Idle; }));
  EXPECT_EQ(cam().queue().moves_left(), 0);
  ASSERT_TRUE(machine_.controller.last_stop());
  EXPECT_THAT(machine_.controller.last_stop()->message, HasSubstr("StopNow"));
}

TEST_F(BesideAProgram, LetsTheProgramBeParkedAfterTheyLetGo) {
  hold();
  EXPECT_THAT(cam().parking().park().error().message, HasSubstr("panel"));
  operating().let_go();
  EXPECT_EQ(now().state, CycleState::Holding);
  EXPECT_TRUE(cam().parking().park());
}

TEST_F(BesideAProgram, TellsTheLastStopUntilTheCycleRunsAgain) {
  ASSERT_TRUE(cam().cycle().stop());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.last_stop().has_value(); }));
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  EXPECT_TRUE(machine_.run_until([&] { return !machine_.controller.last_stop(); }));
}

class AfterItsProgram : public BesideAProgram {
 protected:
  void SetUp() override {
    BesideAProgram::SetUp();
    ASSERT_TRUE(cam().cycle().set_feed_override(200));
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 1));
  }
};

TEST_F(AfterItsProgram, TheCycleSaysThatItWaitsForMoves) {
  ASSERT_TRUE(machine_.run_until([&] { return now().waits_for != nullptr; })) << "it comes to rest first";
  EXPECT_STREQ(now().waits_for, "moves");
  EXPECT_THAT(cam().positioning().jog_joint(1, 1).error().message, HasSubstr("waits for moves"));
}

// Red when the stop at the end of a clean run looks like a fault or a StopNow.
TEST_F(AfterItsProgram, TheLastStopIsTheCyclesEnd) {
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.last_stop().has_value(); }));
  EXPECT_EQ(machine_.controller.last_stop()->message, "the cycle has ended: all that was queued is done");
}

TEST(JogWhileWaiting, EndsTheCycleAndRunsTheJogAlone) {
  ControllerOptions options = TestMachine::options();
  options.jog_while_waiting = true;
  TestMachine machine(options);
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::RmacCam& cam = machine.controller.cam();
  ASSERT_TRUE(cam.cycle().start(sdk::CycleMode::Automatic));
  const auto jogged = cam.positioning().jog_joint(1, 2);
  ASSERT_TRUE(jogged) << jogged.error().message;
  ASSERT_TRUE(machine.run_until_event(Event::Kind::Stopped));
  EXPECT_EQ(machine.controller.cycle_now().state, CycleState::Idle) << "the next program starts its own cycle";
  EXPECT_NEAR(machine.controller.sample().position_set[1], 2, 1e-9);
  ASSERT_TRUE(cam.cycle().start(sdk::CycleMode::Automatic));
  EXPECT_FALSE(cam.positioning().jog_joint(1, 1000)) << "beyond its limit";
  EXPECT_EQ(machine.controller.cycle_now().state, CycleState::Running) << "what is refused ends nothing";
}

}  // namespace
}  // namespace rmac::gateway
