#include "gateway/api/rpc_error.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/program/runner_bench.hpp"

namespace rmac::cli {
namespace {

using gateway::Answer;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = gateway::Event::Kind;

TEST_F(RunnerTest, StartsTheCycleOfAProgramThatDoesNotAndCountsItsMoves) {
  move(1);
  move(2);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->requests, 2U);
  EXPECT_EQ(report->moves, 2U);
  EXPECT_DOUBLE_EQ(report->cycle_time_s, 2) << "from the first start to the last end, by the machine's clock";
  const auto methods = appliance_.methods();
  EXPECT_EQ(methods.front(), kAcquireAuthority);
  EXPECT_EQ(methods.back(), kReleaseAuthority);
  EXPECT_THAT(appliance_.params_of(kStart), ElementsAre(json{{"Mode", "AUTOMATIC"}}));
}

TEST_F(RunnerTest, RenewsALeaseThatEndsBySilenceWhileItWaits) {
  appliance_.answers(kAcquireAuthority, {{"timeout_s", 0.03}, {"dropped_moves", 0}});
  appliance_.handles(kMove, [](const json&) { return Answer(true); });
  appliance_.handles(kRenewAuthority, [this](const json&) {
    if (count(kRenewAuthority) == 3) move_is_done(1);
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->moves, 1U);
}

TEST_F(RunnerTest, LeavesTheStartToAProgramThatHasOne) {
  move(1);
  line(kStart, {{"Mode", "MANUAL"}});
  ASSERT_TRUE(run());
  EXPECT_THAT(appliance_.params_of(kStart), ElementsAre(json{{"Mode", "MANUAL"}}));
}

TEST_F(RunnerTest, AsksForTheStartAgainWhileAJogComesToRest) {
  int asked = 0;
  appliance_.handles(kStart, [&](const json&) -> Answer {
    if (++asked < 3) return tl::unexpected(gateway::RpcError{-32001, "the machine moves", MinorCode::Unknown});
    return true;
  });
  move(1);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(asked, 3);
}

TEST_F(RunnerTest, StopsTheMachineAtARefusedRequestAndNamesItsLine) {
  move(1);
  line("RMAC_CAM.SetFeedrate", {{"Feedrate", 9}});
  move(2);
  line("RMAC_CAM.SetPartFrame", {{"PartFrame", json::object()}});
  line("RMAC_CAM.TurnCoolantOn");
  appliance_.refuses("RMAC_CAM.SetPartFrame", -32014, "no frame");
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "p.rmac:4: RMAC_CAM.SetPartFrame: no frame");
  const auto methods = appliance_.methods();
  EXPECT_THAT(methods, testing::Contains("RMAC_CAM.StopNow"));
  EXPECT_EQ(methods.back(), kReleaseAuthority);
}

TEST_F(RunnerTest, SendsNothingBehindARefusedMoveThatItWaitedFor) {
  appliance_.refuses(kMove, -32004, "out of reach");
  move(1);
  line("RMAC_CAM.Home");
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "p.rmac:1: RMAC_CAM.MoveToXYZ: out of reach");
  EXPECT_EQ(count("RMAC_CAM.Home"), 0U);
}

TEST_F(RunnerTest, SendsNoMoveThatBeginsAnywhereBehindOneThatMayBeRefused) {
  appliance_.refuses(kMove, -32004, "out of reach");
  move(1);
  move(2);
  ASSERT_FALSE(run());
  EXPECT_EQ(count(kMove), 1U);
}

TEST_F(RunnerTest, FailsByAFaultAsTheMachineTellsIt) {
  appliance_.handles(kMove, [&](const json&) {
    appliance_.push_event(Kind::Fault, {{"message", "joint 1 follows too late"}});
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "joint 1 follows too late");
  EXPECT_EQ(count("RMAC_CAM.StopNow"), 1U);
}

TEST_F(RunnerTest, SaysHowManyMovesAreNotDoneWhenAnotherClientStopsTheMachine) {
  appliance_.handles(kMove, [&](const json& params) {
    if (params.at("MoveID") == 2) appliance_.push_event(Kind::Stopped, {{"message", "stopped"}});
    return Answer(true);
  });
  move(1);
  move(2);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "the machine was stopped and its queue emptied: 2 moves are not done");
}

TEST_F(RunnerTest, GoesOnWhenTheMachineThatStoppedKeepsItsMoves) {
  appliance_.handles(kMove, [&](const json&) {
    type_once_heard("");
    return Answer(true);
  });
  appliance_.handles("RMAC_CAM.FeedResume", [&](const json&) {
    move_is_done(1);
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
}

TEST_F(RunnerTest, FailsWhenAnotherClientStopsTheCycle) {
  appliance_.handles(kMove, [&](const json&) {
    appliance_.push_event(Kind::Stopped);
    appliance_.handles("RMAC_CAM.GetState", [&](const json&) {
      appliance_.answers("RMAC_CAM.GetState", state());
      return Answer(state({{"moves_in_buffer", 1}, {"mode", "AUTOMATIC"}}));
    });
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "the cycle was stopped: 1 moves are not done");
}

TEST_F(RunnerTest, RefusesToBeginWhileMovesOfAnEarlierProgramAreQueued) {
  appliance_.answers("RMAC_CAM.GetState", state({{"moves_in_buffer", 3}}));
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "3 moves of an earlier program are still queued: end them with `rmac stop` first");
  EXPECT_EQ(count(kMove), 0U);
  EXPECT_EQ(count("RMAC_CAM.StopNow"), 0U) << "they may be somebody's who comes back";
}

TEST_F(RunnerTest, TouchesNothingWithoutMotionAuthority) {
  appliance_.refuses(kAcquireAuthority, gateway::rpc_code::kAuthorityHeld, "the panel has it");
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "the panel has it");
  EXPECT_EQ(report.error().rpc_code, gateway::rpc_code::kAuthorityHeld);
  EXPECT_THAT(appliance_.methods(), ElementsAre(kAcquireAuthority));
}

TEST_F(RunnerTest, SaysThatTheConnectionEndedInMidProgram) {
  appliance_.handles(kMove, [&](const json& params) {
    if (params.at("MoveID") == 2) appliance_.hang_up();
    return Answer(true);
  });
  move(1);
  move(2);
  move(3);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("the connection to " + appliance_.endpoint().socket + " ended: "));
}

TEST_F(RunnerTest, SendsNoMoreMovesThanTheQueueHolds) {
  appliance_.answers("hello", {{"limits", {{"queue_capacity", 2}}}});
  appliance_.handles(kMove, [&](const json& params) {
    if (params.at("MoveID") > 1) appliance_.type("1");
    return Answer(true);
  });
  // The client asked for this behind all that it had sent without waiting.
  std::vector<std::size_t> sent;
  std::int64_t done = 0;
  appliance_.handles("RMAC_CAM.FeedRetrace", [&](const json&) {
    sent.push_back(count(kMove));
    move_is_done(++done);
    if (done == 4) move_is_done(5);
    return Answer(1.0);
  });
  for (int id = 1; id <= 5; ++id) move(id);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(sent, ElementsAre(2, 3, 4, 5)) << "with 0, 1, 2 and 3 of them done";
}

TEST_F(RunnerTest, SendsOneRequestAtATimeWhereNothingIsSaidOfTheQueue) {
  appliance_.answers("hello", json::object());
  appliance_.refuses(kMove, -32015, "the queue is full");
  move(1);
  move(2);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(count(kMove), 1U) << "a later move behind a refused one leaves a gap in the part";
}

TEST_F(RunnerTest, WaitsForAMeasuredPointBeforeTheNextMove) {
  appliance_.handles("RMAC_CAM.AutoMeasure", [&](const json&) {
    appliance_.type("1");
    return Answer(true);
  });
  std::size_t sent_before_done = 99;
  appliance_.handles("RMAC_CAM.FeedRetrace", [&](const json&) {
    sent_before_done = count(kMove);
    move_is_done(1);
    return Answer(1.0);
  });
  line("RMAC_CAM.AutoMeasure", {{"MoveID", 1}, {"x", 0}, {"y", 0}, {"z", 0}, {"Speed", 1}});
  move(2);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(sent_before_done, 0U);
  EXPECT_EQ(count(kMove), 1U);
}

TEST_F(RunnerTest, LoadsWhatTheProgramLoadsInVirtualModeWhenAskedTo) {
  options_.virtual_mode = true;
  line("Device.Load", {{"Name", "BenchXYZ"}});
  ASSERT_TRUE(run());
  EXPECT_THAT(appliance_.params_of("Device.Load"), ElementsAre(json{{"Name", "BenchXYZ"}, {"Virtual", true}}));
}

TEST_F(RunnerTest, LoadsTheLoadedMachineAgainForVirtualMode) {
  appliance_.answers("Device.Machine_GetMechanismName", "CMM500");
  options_.virtual_mode = true;
  move(1);
  ASSERT_TRUE(run());
  EXPECT_THAT(appliance_.params_of("Device.Load"), ElementsAre(json{{"Name", "CMM500"}, {"Virtual", true}}));
}

TEST_F(RunnerTest, LoadsTheMachineOfTheOptionsFirst) {
  options_.machine = "Hexapod";
  move(1);
  ASSERT_TRUE(run());
  EXPECT_THAT(appliance_.params_of("Device.Load"), ElementsAre(json{{"Name", "Hexapod"}, {"Virtual", false}}));
}

TEST_F(RunnerTest, DoesNotRunAQueueThatItsProgramStartsTooLate) {
  move(1);
  line("RMAC_CAM.Home");
  line(kStart, {{"Mode", 1}});
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message,
            "p.rmac:2: RMAC_CAM.Home needs the moves before it done, but the program starts its cycle later");
}

TEST_F(RunnerTest, EndsWithTheToolThatItsProgramChangedTo) {
  appliance_.handles("RMAC_CAM.DoToolChange", [&](const json&) {
    appliance_.push_event(Kind::ToolWanted, {{"message", "put tool 4 into the spindle"}});
    appliance_.push("state", state({{"tool_prompt", "put tool 4 into the spindle"}, {"tool_wanted", 4}}));
    type_once_heard("");
    return Answer(true);
  });
  appliance_.handles("RMAC_CAM.ConfirmToolChange", [&](const json&) {
    appliance_.push_event(Kind::ToolChanged);
    return Answer(true);
  });
  line("RMAC_CAM.DoToolChange", {{"ToolNumber", 4}});
  testing::internal::CaptureStderr();
  const auto report = run();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "rmac: put tool 4 into the spindle\n");
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.ConfirmToolChange"), ElementsAre(json{{"ToolNumber", 4}}));
  EXPECT_EQ(report->moves, 0U) << "a tool change is no move";
}

TEST_F(RunnerTest, FailsWhenAToolChangeIsDropped) {
  appliance_.handles("RMAC_CAM.DoToolChange", [&](const json&) {
    appliance_.push_event(Kind::ToolChangeDropped, {{"message", "tool 4 is not in the spindle"}});
    return Answer(true);
  });
  line("RMAC_CAM.DoToolChange", {{"ToolNumber", 4}});
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "tool 4 is not in the spindle");
}

}  // namespace
}  // namespace rmac::cli
