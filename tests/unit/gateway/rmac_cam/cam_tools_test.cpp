#include "gateway/rmac_cam/cam_tools.hpp"

#include "gateway/rmac_cam/cam_program_flow.hpp"
#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

const Tool kMill{.number = 1, .name = "end mill", .length_mm = 50, .max_rpm = 800, .max_torque_nm = 3};
const Tool kProbe{.number = 2, .length_mm = 90, .needs_spindle = false};

class Tools : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    ASSERT_TRUE(tools_.set_tool(kMill));
    ASSERT_TRUE(tools_.set_tool(kProbe));
  }
  [[nodiscard]] double tip_z() { return supervisor_.wishes().frames.tool.p[2]; }
  /// Runs the cycle as far as it goes without a servo loop: to the first step that waits for somebody.
  void run() {
    ASSERT_TRUE(supervisor_.command([](CycleSequencer& cycle, const CycleObservation& seen) {
      return cycle.start(sdk::CycleMode::Automatic, seen);
    }));
    for (int i = 0; i < 3; ++i) (void)supervisor_.advance(status_);
  }
};

TEST_F(Tools, AreListedByNumber) {
  const auto all = tools_.tools();
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->front().name, "end mill");
  ASSERT_TRUE(tools_.remove_tool(1));
  EXPECT_EQ(tools_.tools()->front().number, 2);
}

TEST_F(Tools, InTheSpindleAreInForceAtOnceAndKeepThePartFrame) {
  supervisor_.set_frames({{{5, 0, 0}, {1, 0, 0, 0}}, {}});
  supervisor_.set_mounted(1);
  ASSERT_TRUE(tools_.set_tool({.number = 2, .length_mm = 91}));
  EXPECT_EQ(tip_z(), 0) << "it is in the rack";
  ASSERT_TRUE(tools_.set_tool({.number = 1, .length_mm = 51, .max_torque_nm = 2}));
  EXPECT_EQ(tip_z(), -51);
  EXPECT_EQ(supervisor_.wishes().tool_torque_nm, 2);
  EXPECT_EQ(supervisor_.wishes().frames.part.p[0], 5);
}

TEST_F(Tools, InTheSpindleChangeAtRestOnly) {
  supervisor_.set_mounted(2);
  ASSERT_TRUE(path_.set_feedrate(600));
  ASSERT_TRUE(queue_line(1, {0, 0, 0}, {10, 0, 0}));
  EXPECT_THAT(tools_.set_tool(kProbe).error().message, HasSubstr("SetTool of a tool in use needs an empty queue"));
  EXPECT_TRUE(tools_.set_tool(kMill)) << "it is in the rack";
}

TEST_F(Tools, ByHandArePutInWhenAPersonSaysSo) {
  ASSERT_TRUE(tools_.change_tool(1));
  EXPECT_THAT(tools_.tools_now().wanted, Optional(1));
  EXPECT_FALSE(rack_.mounted()) << "whoever ends now must not be believed to have the old one";
  EXPECT_FALSE(tools_.remove_tool(2)) << "a change is queued";
  run();
  EXPECT_EQ(tools_.tools_now().prompt, "insert tool 1 (end mill), then confirm: rmac confirm 1");
  EXPECT_THAT(tools_.check_speed(100).error().message, HasSubstr("a tool change is under way"));
  ASSERT_TRUE(tools_.confirm_tool(1));
  EXPECT_THAT(tools_.tools_now().mounted, Optional(1));
  EXPECT_EQ(tip_z(), -50);
  ASSERT_TRUE(tools_.keep_mounted());
  EXPECT_THAT(rack_.mounted(), Optional(1));
}

TEST_F(Tools, ThatAreThereAlreadyAskNobody) {
  supervisor_.set_mounted(1);
  ASSERT_TRUE(rack_.set_mounted(1));
  ASSERT_TRUE(tools_.change_tool(1));
  EXPECT_THAT(rack_.mounted(), Optional(1));
  run();
  EXPECT_EQ(tools_.tools_now().prompt, "");
  EXPECT_FALSE(tools_.tools_now().wanted) << "done";
}

TEST_F(Tools, MovesBehindAChangeGoWithTheNewTool) {
  ASSERT_TRUE(tools_.change_tool(1));
  EXPECT_EQ(mechanism_->builder.frames().tool.p[2], -50);
  EXPECT_EQ(mechanism_->builder.end_pose().tip[2], -50);
  EXPECT_EQ(tip_z(), 0) << "the machine itself still has none";
}

TEST_F(Tools, OfAnAutomaticChangeThatIsNotDescribedStayWhereTheyAre) {
  sdk::DeviceObject device = mechanism_->device;
  device.tool_changer = true;
  device_.change(&device);
  EXPECT_THAT(tools_.change_tool(1).error().message, HasSubstr("not what that does"));
  EXPECT_TRUE(tools_.change_tool(kNoTool)) << "that one is in already";
  device.tool_change = {{.kind = sdk::ToolChangeStep::Kind::Switch, .outputs = {"Coolant"}}};
  supervisor_.set_mounted(std::nullopt);
  ASSERT_TRUE(
      supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.stop_and_clear({}); }));
  EXPECT_THAT(tools_.change_tool(1).error().message, HasSubstr("which tool is in the spindle is not known"));
}

TEST_F(Tools, OfAChangeThatCannotBeLeaveTheQueuesEndWhereItWas) {
  sdk::DeviceObject device = mechanism_->device;
  device.tool_changer = true;
  using Step = sdk::ToolChangeStep;
  device.tool_change = {{.kind = Step::Kind::MoveTo, .joints = {40, 40, 40}},
                        {.kind = Step::Kind::Select, .outputs = {"Coolant"}}};
  device_.change(&device);
  EXPECT_THAT(tools_.change_tool(2).error().message, HasSubstr("tool 2 has no place in the changer"));
  EXPECT_THAT(mechanism_->builder.end_joints(), ElementsAre(0, 0, 0));
  EXPECT_THAT(rack_.mounted(), Optional(kNoTool)) << "nothing has begun";
}

TEST_F(Tools, ThatNobodyKnowsAreSaidByAPerson) {
  supervisor_.set_mounted(std::nullopt);
  EXPECT_THAT(tools_.check_move(4, false).error().message,
              HasSubstr("move 4: which tool is in the spindle is not known"));
  EXPECT_THAT(tools_.check_speed(100).error().message, HasSubstr("which tool is in the spindle is not known"));
  EXPECT_TRUE(tools_.check_speed(0));
  ASSERT_TRUE(tools_.confirm_tool(1));
  EXPECT_THAT(tools_.tools_now().mounted, Optional(1));
  EXPECT_THAT(rack_.mounted(), Optional(1));
  EXPECT_EQ(tip_z(), -50);
  EXPECT_TRUE(tools_.confirm_tool(1)) << "so it is";
  EXPECT_THAT(tools_.confirm_tool(2).error().message, HasSubstr("tool 1 is in the spindle and no change is under way"));
}

TEST_F(Tools, CutWithTheSpindleTurningUnlessTheySayOtherwise) {
  supervisor_.set_mounted(1);
  EXPECT_TRUE(tools_.check_move(4, false));
  EXPECT_THAT(tools_.check_move(4, true).error().message,
              HasSubstr("move 4: tool 1 (end mill) needs the spindle turning; "));
  supervisor_.set_spindle(0, 100);
  EXPECT_TRUE(tools_.check_move(4, true));
  ASSERT_TRUE(tools_.change_tool(2));
  EXPECT_TRUE(tools_.check_move(5, true)) << "a probe";
  ASSERT_TRUE(tools_.change_tool(1));
  EXPECT_THAT(tools_.check_move(6, true).error().message, HasSubstr("and its change stops it; use SetSpindleRPM when"));
}

// Red when a program cannot change its tool and go on cutting without a client that waits for the change.
TEST_F(Tools, CutBehindTheSpeedThatTheProgramGivesThemInItsTurn) {
  CamSpindles spindles{device_, supervisor_, link_.history, tools_};
  spindles.mechanism_changed();
  CamProgramFlow flow{device_, supervisor_, spindles};
  supervisor_.set_mounted(1);
  ASSERT_TRUE(flow.in_turn(1, {sdk::SpindleCall{0, 500}}));
  EXPECT_EQ(supervisor_.wishes().spindle_rpm[0], 0) << "not before its turn";
  EXPECT_TRUE(tools_.check_move(2, true));
  ASSERT_TRUE(tools_.change_tool(2));
  ASSERT_TRUE(tools_.change_tool(1));
  EXPECT_FALSE(tools_.check_move(3, true)) << "the change stops the spindle";
  EXPECT_EQ(flow.in_turn(4, {sdk::SpindleCall{0, 900}}).error().message,
            "InTurn: 900 rpm is above the 800 rpm that tool 1 (end mill) may turn");
  ASSERT_TRUE(flow.in_turn(4, {sdk::SpindleCall{0, -700}}));
  EXPECT_TRUE(tools_.check_move(5, true));
  ASSERT_TRUE(flow.in_turn(6, {sdk::SpindleCall{0, 0}}));
  EXPECT_FALSE(tools_.check_move(7, true));
}

TEST_F(Tools, BoundTheSpindlesSpeed) {
  supervisor_.set_mounted(1);
  EXPECT_TRUE(tools_.check_speed(-800));
  EXPECT_EQ(tools_.check_speed(-801).error().message,
            "SetSpindleRPM: -801 rpm is above the 800 rpm that tool 1 (end mill) may turn");
  supervisor_.set_mounted(2);
  EXPECT_TRUE(tools_.check_speed(5000));
}

TEST_F(Tools, AreThoseOfAnotherMechanismsTable) {
  rack_.adopt("Lathe", {{{3, {.number = 3, .length_mm = 20, .max_torque_nm = 1}}}, 3}, ToolRack::Keeps::Nothing);
  tools_.mechanism_changed(false);
  EXPECT_THAT(tools_.tools_now().mounted, Optional(kNoTool)) << "the same mechanism, configured anew";
  tools_.mechanism_changed(true);
  EXPECT_THAT(tools_.tools_now().mounted, Optional(3));
  EXPECT_EQ(tip_z(), -20);
  EXPECT_EQ(supervisor_.wishes().tool_torque_nm, 1);
  device_.change(nullptr);
  tools_.mechanism_changed(true);
  EXPECT_THAT(tools_.tools_now().mounted, Optional(kNoTool));
  EXPECT_FALSE(tools_.tools());
}

}  // namespace
}  // namespace rmac::gateway
