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

/// Refuses a method until the lease is taken.
void needs_lease(FakeAppliance& appliance, const std::string& method) {
  appliance.refuses(method, gateway::rpc_code::kAuthorityRequired, "needs motion authority");
  appliance.handles(kAcquireAuthority, [&appliance, method](const json&) {
    appliance.answers(method, true);
    return gateway::Answer(json::object());
  });
}

TEST_F(CycleCommands, StopAndHoldWithoutTheLease) {
  EXPECT_EQ(run({"stop"}).exit_code, 0);
  EXPECT_EQ(run({"hold"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.StopNow", "RMAC_CAM.FeedHold"));
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
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.SetFeedOverride"));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetFeedOverride"), ElementsAre(json{{"Percent", 50.0}}));
}

TEST_F(CycleCommands, TakeTheLeaseForTheOverrideWhereNobodyHasIt) {
  needs_lease(appliance_, "RMAC_CAM.SetFeedOverride");
  EXPECT_EQ(run({"override", "0"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.SetFeedOverride", kAcquireAuthority,
                                                "RMAC_CAM.SetFeedOverride", kReleaseAuthority));
}

TEST_F(CycleCommands, GoOnWithTheLeaseWhereNobodyHasIt) {
  needs_lease(appliance_, "RMAC_CAM.FeedResume");
  EXPECT_EQ(run({"resume"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(),
              ElementsAre("RMAC_CAM.FeedResume", kAcquireAuthority, "RMAC_CAM.FeedResume", kReleaseAuthority));
}

TEST_F(CycleCommands, TakeNoLeaseWhenGoingOnIsRefusedForAnotherReason) {
  appliance_.refuses("RMAC_CAM.FeedResume", -32001, "nothing is held");
  EXPECT_EQ(run({"resume"}).err, "rmac: nothing is held\n");
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.FeedResume"));
}

TEST_F(CycleCommands, TakeAnOverrideOfUpToTwiceTheFeed) {
  EXPECT_EQ(run({"override", "200"}).exit_code, 0);
  EXPECT_EQ(run({"override", "200.1"}).exit_code, 2);
  EXPECT_EQ(run({"override", "-1"}).exit_code, 2);
  EXPECT_EQ(run({"override"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
