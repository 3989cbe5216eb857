// What a person does at the prompt of a program that is held.
#include <algorithm>

#include "gateway/api/rpc_error.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/program/runner_bench.hpp"

namespace rmac::cli {
namespace {

using gateway::Answer;
using nlohmann::json;
using testing::ElementsAre;
using Kind = gateway::Event::Kind;

/// A program that is held in its first move, until the test lets a person go on.
class HeldRunnerTest : public RunnerTest {
 protected:
  void hold_and_type(const std::string& entered) {
    appliance_.handles(kMove, [this, entered](const json& params) {
      if (params.at("MoveID") == 2) {
        appliance_.push("state", state({{"state", "Holding"}, {"moves_in_buffer", 2}}));
        appliance_.type(entered);
      }
      return Answer(true);
    });
    move(1);
    move(2);
  }
  void finish() {
    move_is_done(1);
    move_is_done(2);
  }
};

TEST_F(HeldRunnerTest, GoesOnAtAnEmptyLine) {
  hold_and_type("");
  appliance_.handles("RMAC_CAM.FeedResume", [&](const json&) {
    finish();
    return Answer(true);
  });
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->moves, 2U);
  EXPECT_EQ(count("RMAC_CAM.FeedResume"), 1U);
}

TEST_F(HeldRunnerTest, RunsBackByTheDistanceThatIsEnteredAndThenGoesOn) {
  hold_and_type("2.5");
  appliance_.handles("RMAC_CAM.FeedRetrace", [&](const json&) {
    appliance_.type("");
    return Answer(2.5);
  });
  appliance_.handles("RMAC_CAM.FeedResume", [&](const json&) {
    finish();
    return Answer(true);
  });
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.FeedRetrace"), ElementsAre(json{{"Distance", 2.5}}));
}

TEST_F(HeldRunnerTest, GivesTheMachineFreeWhenParkedAndTakesTheProgramUpAgain) {
  hold_and_type("p");
  // The first move was done before the parking; nobody told yet.
  appliance_.answers("RMAC_CAM.GetParkedProgram", {{"moves", 1}});
  appliance_.handles(kReleaseAuthority, [&](const json&) {
    if (count(kReleaseAuthority) == 1) {
      // What somebody else does meanwhile is not the program's.
      appliance_.push_event(Kind::Stopped);
      appliance_.push_event(Kind::Fault, {{"message", "a fault of somebody else's jog"}});
      move_is_done(2);
      appliance_.type("");
    }
    return Answer(true);
  });
  appliance_.handles("RMAC_CAM.FeedResume", [&](const json&) {
    move_is_done(2);
    return Answer(true);
  });
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->moves, 2U);
  const auto methods = appliance_.methods();
  const auto parked = std::ranges::find(methods, "RMAC_CAM.ParkProgram");
  const std::vector<std::string> behind(parked, methods.end());
  EXPECT_THAT(behind, ElementsAre("RMAC_CAM.ParkProgram", kReleaseOperator, "RMAC_CAM.GetParkedProgram",
                                  kReleaseAuthority, kAcquireAuthority, "RMAC_CAM.TakeUpProgram", kAcquireOperator,
                                  "RMAC_CAM.FeedResume", kReleaseOperator, "RMAC_CAM.GetState", kReleaseAuthority));
}

TEST_F(HeldRunnerTest, SendsNothingOfAParkedProgram) {
  hold_and_type("p");
  appliance_.answers("hello", {{"limits", {{"queue_capacity", 2}}}});
  move(3);
  appliance_.answers("RMAC_CAM.GetParkedProgram", {{"moves", 0}});  // there is room for a third move now
  appliance_.handles(kReleaseAuthority, [&](const json&) {
    if (count(kReleaseAuthority) == 1) appliance_.type("");
    return Answer(true);
  });
  std::size_t sent_before = 99;
  appliance_.handles("RMAC_CAM.TakeUpProgram", [&](const json&) {
    sent_before = count(kMove);
    appliance_.handles(kMove, [&](const json& params) {
      move_is_done(params.at("MoveID"));
      return Answer(true);
    });
    return Answer(true);
  });
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(sent_before, 2U);
  EXPECT_EQ(count(kMove), 3U);
}

TEST_F(HeldRunnerTest, KeepsTheProgramWhenParkingIsRefused) {
  hold_and_type("p");
  appliance_.handles("RMAC_CAM.ParkProgram", [&](const json&) -> Answer {
    type_once_heard("");
    return tl::unexpected(gateway::RpcError{-32001, "only what is held can be parked", MinorCode::Unknown});
  });
  appliance_.handles("RMAC_CAM.FeedResume", [&](const json&) {
    finish();
    return Answer(true);
  });
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(count(kReleaseAuthority), 1U) << "at the end alone";
}

}  // namespace
}  // namespace rmac::cli
