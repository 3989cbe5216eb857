#include "gateway/cycle/tool_change.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class ToolSteps : public testing::Test {
 protected:
  using Outcome = ToolChange::Outcome;

  Outcome take(QueueStep step, const ToolChange::Seen& seen = {}) { return tools_.take(step, seen); }
  [[nodiscard]] std::vector<Event> told() { return news_.take().events; }

  LatestValue<ServoWishes> servo_;
  StandingWishes wishes_{servo_};
  CycleNews news_;
  ToolChange tools_{wishes_, news_};
};

TEST_F(ToolSteps, BeginWithTheSpindleAndTheCoolantOffAndNoToolKnown) {
  wishes_.change([](ServoWishes& wish) {
    wish.spindle_rpm[0] = 500;
    wish.outputs = 0b11;
  });
  EXPECT_EQ(take(BeginToolChange{0b10}), Outcome::Begun);
  EXPECT_EQ(servo_.read().spindle_rpm[0], 0);
  EXPECT_EQ(servo_.read().outputs, 0b01U);
  EXPECT_TRUE(tools_.changing());
  EXPECT_EQ(tools_.now({}).mounted, std::nullopt) << "who ends in the midst must not be believed to have the old tool";
}

TEST_F(ToolSteps, SwitchOutputsOnAndOffAndNoOthers) {
  wishes_.change([](ServoWishes& wish) { wish.outputs = 0b1001; });
  EXPECT_EQ(take(SwitchOutputs{.mask = 0b0011, .values = 0b0110}), Outcome::Done);
  EXPECT_EQ(servo_.read().outputs, 0b1010U);
}

TEST_F(ToolSteps, WaitForAnInputAndFailWhenItDoesNotCome) {
  QueueStep step = AwaitInput{.bit = 0b100, .on = true, .timeout_s = 2, .name = "Clamped"};
  EXPECT_EQ(tools_.take(step, {.t_s = 10, .inputs = 0b011}), Outcome::Waits);
  EXPECT_EQ(tools_.take(step, {.t_s = 12, .inputs = 0b011}), Outcome::Waits);
  EXPECT_EQ(tools_.take(step, {.t_s = 11, .inputs = 0b100}), Outcome::Done);
  EXPECT_TRUE(told().empty());
  EXPECT_EQ(tools_.take(step, {.t_s = 12.1, .inputs = 0}), Outcome::Failed) << "counted from when it was first asked";
  const auto events = told();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, Event::Kind::Fault);
  EXPECT_EQ(events[0].code, MinorCode::ResponseTimeout);
  EXPECT_THAT(events[0].message, HasSubstr("input Clamped did not go on within 2 s"));
  EXPECT_EQ(take(AwaitInput{.bit = 0b100, .on = false, .timeout_s = 2, .name = "Clamped"}, {.inputs = 0}),
            Outcome::Done);
  EXPECT_EQ(take(AwaitInput{.bit = 1, .on = true, .timeout_s = 2, .name = "X"}, {.virtual_mode = true}), Outcome::Done)
      << "no device is behind it";
}

TEST_F(ToolSteps, AskAPersonOnceAndTakeTheToolThatWasAskedFor) {
  const std::deque<QueueStep> queued{AskPerson{"insert T4"}, MountTool{.number = 4}, MountTool{.number = 6}};
  EXPECT_FALSE(tools_.confirm(4, queued, CycleState::Running)) << "nobody was asked";
  EXPECT_EQ(take(AskPerson{"insert T4"}), Outcome::Waits);
  EXPECT_EQ(take(AskPerson{"insert T4"}), Outcome::Waits);
  EXPECT_EQ(told().size(), 1U);
  EXPECT_EQ(tools_.now(queued).prompt, "insert T4");
  EXPECT_EQ(tools_.now(queued).wanted, 4);
  EXPECT_EQ(tools_.now(queued).last, 6);
  EXPECT_FALSE(tools_.confirm(6, queued, CycleState::Running));
  EXPECT_FALSE(tools_.confirm(4, queued, CycleState::Faulted));
  EXPECT_TRUE(tools_.asked()) << "a refusal leaves the question";
  EXPECT_TRUE(tools_.confirm(4, queued, CycleState::Idle));
  EXPECT_FALSE(tools_.asked());
}

TEST_F(ToolSteps, MountTheToolWithItsTipAndTheTorqueThatItBears) {
  (void)take(BeginToolChange{});
  MountTool mount{.number = 4, .text = "T4", .max_torque_nm = 1.5};
  mount.tip.p = {0, 0, -80};
  EXPECT_EQ(take(mount), Outcome::Mounted);
  EXPECT_EQ(tools_.now({}).mounted, 4);
  EXPECT_FALSE(tools_.changing());
  EXPECT_EQ(servo_.read().frames.tool.p[2], -80);
  EXPECT_EQ(servo_.read().tool_torque_nm, 1.5);
  EXPECT_EQ(told().back().kind, Event::Kind::ToolChanged);
}

TEST_F(ToolSteps, SayWhenDroppedWhetherTheToolIsKnown) {
  tools_.set_mounted(3, 0);
  tools_.drop(false);
  EXPECT_TRUE(told().empty());
  tools_.drop(true);
  EXPECT_THAT(told().back().message, HasSubstr("the spindle has the tool that it had"));
  EXPECT_EQ(tools_.now({}).mounted, 3);
  (void)take(BeginToolChange{});
  (void)take(AskPerson{"insert"});
  (void)told();
  tools_.drop(true);
  EXPECT_THAT(told().back().message, HasSubstr("is not known"));
  EXPECT_FALSE(tools_.asked());
  EXPECT_FALSE(tools_.changing());
  EXPECT_EQ(tools_.now({}).mounted, std::nullopt);
}

}  // namespace
}  // namespace rmac::gateway
