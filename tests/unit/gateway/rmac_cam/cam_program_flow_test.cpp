#include "gateway/rmac_cam/cam_program_flow.hpp"

#include <cmath>
#include <limits>

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class ProgramFlowOfTheMill : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    named_ = mechanism_->device;
    named_.inputs = {{"Clamped", 3}, {"Door", 0}};
    named_.outputs["Laser"] = 2;
    describe(named_);
    spindles_.mechanism_changed();
    ASSERT_TRUE(path_.set_feedrate(600));
  }
  sdk::DeviceObject named_;
  CamSpindles spindles_{device_, supervisor_, link_.history, tools_};
  CamProgramFlow flow_{device_, supervisor_, spindles_};
};

TEST_F(ProgramFlowOfTheMill, QueuesEachBehindTheMovesBeforeItAndMovesBehindIt) {
  ASSERT_TRUE(queue_line(1, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(flow_.dwell(2, 0.5));
  ASSERT_TRUE(flow_.stop(3, true, "look at it"));
  ASSERT_TRUE(flow_.await_input(4, "Clamped", true, 2));
  ASSERT_TRUE(queue_line(5, {10, 0, 0}, {10, 5, 0})) << "the next move begins where the one before ended";
  EXPECT_EQ(supervisor_.moves_left(), 5U);
  ASSERT_EQ(queued_.size(), 5U) << "who counts what is done hears of each";
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(queued_[i].id, static_cast<std::int64_t>(i + 1));
}

TEST_F(ProgramFlowOfTheMill, RefusesTimesThatAreNone) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {-1e-9, -5.0, 3600.1, kInfinite, -kInfinite, std::nan("")}) {
    const auto dwell = flow_.dwell(1, wrong);
    ASSERT_FALSE(dwell) << wrong;
    EXPECT_EQ(dwell.error().code, MinorCode::InvalidParameterValue);
    EXPECT_THAT(dwell.error().message, HasSubstr("Dwell: the Time of"));
    const auto input = flow_.await_input(1, "Clamped", true, wrong);
    ASSERT_FALSE(input) << wrong;
    EXPECT_THAT(input.error().message, HasSubstr("AwaitInput: the TimeOut of"));
  }
  EXPECT_TRUE(flow_.dwell(1, 0));
  EXPECT_TRUE(flow_.dwell(2, 3600));
  EXPECT_EQ(supervisor_.moves_left(), 2U) << "what was refused is not queued";
}

TEST_F(ProgramFlowOfTheMill, SaysWhichInputsThereAre) {
  const auto unknown = flow_.await_input(1, "Clampd", true, 2);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message,
            "AwaitInput: there is no input named \"Clampd\"; the DigitalIOInterface of Mill has Clamped, Door");
  const auto hostile = flow_.await_input(1, std::string(100000, '\n'), true, 2);
  ASSERT_FALSE(hostile);
  EXPECT_LT(hostile.error().message.size(), 300U);
  named_.inputs.clear();
  EXPECT_THAT(flow_.await_input(1, "Clamped", true, 2).error().message, HasSubstr("of Mill has none"));
  EXPECT_EQ(supervisor_.moves_left(), 0U);
}

TEST_F(ProgramFlowOfTheMill, QueuesCallsWithoutMakingThem) {
  ASSERT_TRUE(queue_line(1, {0, 0, 0}, {10, 0, 0}));
  ASSERT_TRUE(flow_.in_turn(2, {sdk::SpindleCall{0, 500}, sdk::OutputCall{"Laser", true}}));
  EXPECT_EQ(supervisor_.moves_left(), 2U);
  EXPECT_EQ(supervisor_.wishes().spindle_rpm[0], 0);
  EXPECT_EQ(supervisor_.wishes().outputs, 0U);
}

TEST_F(ProgramFlowOfTheMill, RefusesCallsThatCannotWorkAllTogether) {
  const auto refused = [&](const sdk::CallInTurn& call) {
    const auto answer = flow_.in_turn(2, {sdk::OutputCall{"Laser", true}, call});
    return answer ? std::string("taken") : answer.error().message;
  };
  EXPECT_EQ(refused(sdk::OutputCall{"Lazer", true}),
            "InTurn: there is no output named \"Lazer\"; the DigitalIOInterface of Mill has Coolant, Laser");
  EXPECT_EQ(refused(sdk::SpindleCall{1, 100}), "InTurn: there is no spindle 1; spindles are 0 to 0");
  EXPECT_EQ(refused(sdk::SpindleCall{-1, 100}), "InTurn: there is no spindle -1; spindles are 0 to 0");
  EXPECT_EQ(refused(sdk::SpindleCall{0, 1001}), "InTurn: 1001 rpm is above spindle 0's maximum of 1000 rpm");
  EXPECT_EQ(refused(sdk::SpindleCall{0, std::nan("")}), "InTurn: the speed must be finite");
  named_.tool_change = {{.kind = sdk::ToolChangeStep::Kind::Switch, .outputs = {"Laser"}}};
  EXPECT_EQ(refused(sdk::SpindleCall{0, 1}), "InTurn: the tool changer switches Laser; change tools with DoToolChange");
  named_.spindles.clear();
  named_.tool_change.clear();
  EXPECT_EQ(refused(sdk::SpindleCall{0, 1}), "InTurn: the mechanism has no spindle");
  EXPECT_EQ(supervisor_.moves_left(), 0U) << "nothing of what was refused is queued";
}

TEST_F(ProgramFlowOfTheMill, NeedsAMechanismThatIsNotFaulted) {
  fail();
  EXPECT_THAT(flow_.dwell(1, 1).error().message, HasSubstr("Faulted"));
  device_.change(nullptr);
  EXPECT_THAT(flow_.dwell(1, 1).error().message, HasSubstr("Dwell: no mechanism is loaded"));
  EXPECT_THAT(flow_.stop(1, false, "").error().message, HasSubstr("ProgramStop: no mechanism is loaded"));
  EXPECT_THAT(flow_.await_input(1, "Door", true, 1).error().message, HasSubstr("AwaitInput: no mechanism is loaded"));
}

TEST_F(ProgramFlowOfTheMill, KeepsTheSwitchForOptionalStops) {
  EXPECT_FALSE(flow_.optional_stops());
  flow_.set_optional_stops(true);
  EXPECT_TRUE(flow_.optional_stops());
  put_in(TestMachine::mill());
  EXPECT_TRUE(flow_.optional_stops()) << "it is the machine's, whatever is loaded";
}

}  // namespace
}  // namespace rmac::gateway
