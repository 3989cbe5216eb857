// What the terminal tells; what its lines do to the machine is in runner_test.cpp.
#include "gateway/rmac/program/prompt.hpp"

#include <gmock/gmock.h>

#include "gateway/api/rpc_error.hpp"
#include "unit/gateway/rmac/fake_appliance.hpp"

namespace rmac::cli {
namespace {

class PromptTest : public testing::Test {
 protected:
  PromptTest() : connection_(std::move(*Connection::open(appliance_.endpoint()))), prompt_(*connection_, moves_) {
    appliance_.answers("RMAC_CAM.GetParkedProgram", {{"moves", 0}});
  }

  void hear(const nlohmann::json& members = nlohmann::json::object()) { prompt_.hear(read_state(state(members))); }
  /// Until the appliance has answered what was asked.
  void settle() { ASSERT_TRUE(connection_->call("RMAC_CAM.Ok")); }

  FakeAppliance appliance_;
  std::unique_ptr<Connection> connection_;
  UnfinishedMoves moves_;
  Prompt prompt_;
};

TEST_F(PromptTest, TellsTheFeedWhileTheMachineMoves) {
  hear({{"state", "Running"}, {"feed_actual_mm_min", 1200.4}, {"override_percent", 80}});
  EXPECT_EQ(prompt_.text(), "1200 mm/min, 80 %: h holds, 50% slows down");
}

TEST_F(PromptTest, TellsWhatAPersonMayDoWhenHeld) {
  hear({{"state", "Holding"}});
  EXPECT_EQ(prompt_.text(), "held: Enter goes on, a distance in mm runs back, p parks");
}

TEST_F(PromptTest, TellsWhatToSeeToAtAStopOfTheProgram) {
  hear({{"state", "Holding"}, {"stop_prompt", "program stop 7: turn it over"}});
  EXPECT_EQ(prompt_.text(), "program stop 7: turn it over: Enter goes on, a distance in mm runs back, p parks");
}

TEST_F(PromptTest, AsksForATool) {
  hear({{"state", "Holding"}, {"tool_prompt", "put tool 4 into the spindle"}});
  EXPECT_EQ(prompt_.text(), "put tool 4 into the spindle, or Enter");
}

TEST_F(PromptTest, SaysThatAWordIsNoDistanceAndSendsNothing) {
  hear({{"state", "Holding"}});
  prompt_.obey("3x");
  EXPECT_EQ(prompt_.text(), "\"3x\" is no distance in mm, and no feed override as 50%");
  settle();
  EXPECT_THAT(appliance_.methods(), testing::ElementsAre("RMAC_CAM.Ok"));
}

TEST_F(PromptTest, TellsWhyTheMachineDoesNotRunBack) {
  appliance_.refuses("RMAC_CAM.FeedRetrace", -32013, "there are 2 mm to run back along");
  hear({{"state", "Holding"}});
  prompt_.obey("5");
  settle();
  EXPECT_EQ(prompt_.text(), "there are 2 mm to run back along");
  prompt_.obey("");
  EXPECT_EQ(prompt_.text(), "held: Enter goes on, a distance in mm runs back, p parks") << "the next line is another";
}

// Red when a hold waits for its place in the line, or is the program's to resume.
TEST_F(PromptTest, HoldsAtOnceAndAsTheOperator) {
  hear({{"state", "Running"}});
  prompt_.obey("h");
  for (int answers = 0; answers < 2; ++answers) settle();
  EXPECT_THAT(appliance_.methods(), testing::ElementsAre("RMAC_CAM.FeedHold", "operator.acquire", "RMAC_CAM.Ok",
                                                         "RMAC_CAM.FeedHold", "operator.release", "RMAC_CAM.Ok"));
}

TEST_F(PromptTest, HoldsWhereAnotherIsTheOperator) {
  appliance_.refuses("operator.acquire", gateway::rpc_code::kOperatorThere, "panel is the operator");
  hear({{"state", "Running"}});
  prompt_.obey("h");
  for (int answers = 0; answers < 2; ++answers) settle();
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.FeedHold"), testing::SizeIs(1));
  EXPECT_THAT(appliance_.params_of("operator.release"), testing::IsEmpty()) << "the place is the other one's";
}

TEST_F(PromptTest, SetsTheFeedOverride) {
  hear({{"state", "Running"}});
  prompt_.obey("62.5%");
  settle();
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetFeedOverride"),
              testing::ElementsAre(nlohmann::json{{"Percent", 62.5}}));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.FeedRetrace"), testing::IsEmpty());
}

TEST_F(PromptTest, TellsWhoHoldsWhenTheMachineDoesNotGoOn) {
  appliance_.refuses("operator.acquire", gateway::rpc_code::kOperatorThere, "panel is the operator");
  appliance_.refuses("RMAC_CAM.FeedResume", -32017, "FeedResume: panel, who is the operator, holds the machine");
  hear({{"state", "Holding"}});
  prompt_.obey("");
  settle();
  EXPECT_EQ(prompt_.text(), "FeedResume: panel, who is the operator, holds the machine");
}

TEST_F(PromptTest, TellsHowToTakeUpWhatIsParked) {
  hear();
  prompt_.obey("p");
  EXPECT_TRUE(prompt_.parked());
  EXPECT_EQ(prompt_.text(), "parked: Enter takes it up again");
}

TEST_F(PromptTest, TakesNoOrdersButTheTakingUpWhileParked) {
  hear();
  prompt_.obey("p");
  prompt_.obey("p");
  prompt_.obey("7");
  settle();
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.ParkProgram"), testing::SizeIs(1));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.FeedRetrace"), testing::IsEmpty());
}

TEST_F(PromptTest, StaysParkedWhereTheMachineCannotTakeTheProgramUp) {
  appliance_.refuses("RMAC_CAM.TakeUpProgram", -32014, "the tool is 12 mm from the place");
  hear();
  prompt_.obey("p");
  settle();
  prompt_.obey("");
  for (int answers = 0; answers < 3; ++answers) settle();  // each answer is followed by a request
  EXPECT_TRUE(prompt_.parked());
  EXPECT_EQ(prompt_.text(), "the tool is 12 mm from the place");
  EXPECT_THAT(appliance_.params_of("authority.release"), testing::SizeIs(2)) << "the machine is others' again";
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.FeedResume"), testing::IsEmpty());
}

}  // namespace
}  // namespace rmac::cli
