// Holding, going on, stopping, resetting, and the override.
#include <gmock/gmock.h>

#include "gateway/api/rpc_error.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;

using CycleCommands = CommandBench;

TEST_F(CycleCommands, StopWithoutTheLease) {
  EXPECT_EQ(run({"stop"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.StopNow"));
}

// Red when the hold waits for anything, or is not the operator's.
TEST_F(CycleCommands, HoldAtOnceAndThenAsTheOperator) {
  EXPECT_EQ(run({"hold"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(),
              ElementsAre("RMAC_CAM.FeedHold", kAcquireOperator, "RMAC_CAM.FeedHold", kReleaseOperator));
}

TEST_F(CycleCommands, HoldWhereAnotherIsTheOperatorAndSayWho) {
  appliance_.refuses(kAcquireOperator, gateway::rpc_code::kOperatorThere, "panel is the operator");
  const auto held = run({"hold"});
  EXPECT_EQ(held.exit_code, 0);
  EXPECT_EQ(held.err, "rmac: held, as anyone may; panel is the operator\n");
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.FeedHold", kAcquireOperator));
}

TEST_F(CycleCommands, ResetWithTheLease) {
  EXPECT_EQ(run({"reset"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireAuthority, "RMAC_CAM.Reset", kReleaseAuthority));
}

TEST_F(CycleCommands, GiveTheLeaseBackWhenTheResetIsRefused) {
  appliance_.refuses("RMAC_CAM.Reset", -32002, "the emergency stop is pressed");
  const auto failed = run({"reset"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: the emergency stop is pressed\n");
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(CycleCommands, ChangeTheOverrideBesideARunningProgramWithoutItsLease) {
  EXPECT_EQ(run({"override", "50"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireOperator, "RMAC_CAM.SetFeedOverride", kReleaseOperator));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetFeedOverride"), ElementsAre(json{{"Percent", 50.0}}));
}

TEST_F(CycleCommands, ResumeAsTheOperator) {
  EXPECT_EQ(run({"resume"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireOperator, "RMAC_CAM.FeedResume", kReleaseOperator));
}

TEST_F(CycleCommands, GiveTheOperatorsPlaceUpWhenGoingOnIsRefused) {
  appliance_.refuses("RMAC_CAM.FeedResume", -32001, "nothing is held");
  EXPECT_EQ(run({"resume"}).err, "rmac: nothing is held\n");
  EXPECT_EQ(appliance_.methods().back(), kReleaseOperator);
}

TEST_F(CycleCommands, ResumeNothingWhereAnotherIsTheOperator) {
  appliance_.refuses(kAcquireOperator, gateway::rpc_code::kOperatorThere, "panel is the operator");
  EXPECT_EQ(run({"resume"}).err, "rmac: panel is the operator\n");
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireOperator));
}

TEST_F(CycleCommands, TakeAnOverrideOfUpToTwiceTheFeed) {
  EXPECT_EQ(run({"override", "200"}).exit_code, 0);
  EXPECT_EQ(run({"override", "200.1"}).exit_code, 2);
  EXPECT_EQ(run({"override", "-1"}).exit_code, 2);
  EXPECT_EQ(run({"override"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
