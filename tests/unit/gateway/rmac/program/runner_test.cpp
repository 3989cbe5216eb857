#include "gateway/rmac/program/runner.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "gateway/api/rpc_error.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/fake_appliance.hpp"

namespace rmac::cli {
namespace {

using gateway::Answer;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = gateway::Event::Kind;

constexpr const char* kMove = "RMAC_CAM.MoveToXYZ";
constexpr const char* kStart = "RMAC_CAM.CycleStart";

/// Runs programs of some moves against an appliance that does each at once, unless the test says something else.
class RunnerTest : public testing::Test {
 protected:
  RunnerTest() {
    appliance_.handles(kMove, [this](const json& params) {
      move_is_done(params.at("MoveID"));
      return Answer(true);
    });
  }

  void move_is_done(std::int64_t id) {
    clock_s_ += 1;
    appliance_.push_event(Kind::MoveStarted, {{"move_id", id}, {"t_s", clock_s_ - 1}});
    appliance_.push_event(Kind::MoveDone, {{"move_id", id}, {"t_s", clock_s_}});
  }

  /// Lines of the program; its name is p.rmac.
  void line(const std::string& method, const json& params = json::object()) {
    text_ += json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump() + "\n";
  }
  void move(std::int64_t id) { line(kMove, {{"MoveID", id}, {"x", 1}, {"y", 0}, {"z", 0}, {"Speed", 10}}); }

  Result<RunReport> run() {
    const std::string file = testing::TempDir() + "runner_test.rmac";
    std::ofstream(file) << text_;
    auto program = read_program(file);
    if (!program) return tl::unexpected(program.error());
    program->file = "p.rmac";
    auto connection = Connection::open(appliance_.endpoint());
    if (!connection) return tl::unexpected(connection.error());
    options_.terminal = appliance_.terminal();
    return Runner(**connection, *program, options_).run();
  }

  /// Enters a line when the client has heard all that came before: it asks for the state of a machine that stopped.
  void type_once_heard(const std::string& entered) {
    appliance_.push_event(Kind::Stopped);
    appliance_.handles("RMAC_CAM.GetState", [this, entered](const json&) {
      appliance_.answers("RMAC_CAM.GetState", state());
      appliance_.type(entered);
      return Answer(state({{"moves_in_buffer", 99}, {"mode", "MANUAL"}}));
    });
  }

  /// How often a method was asked for.
  std::size_t count(const std::string& method) { return appliance_.params_of(method).size(); }

  FakeAppliance appliance_;
  std::string text_;
  RunOptions options_;
  double clock_s_ = 100;
};

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

TEST_F(RunnerTest, RecordsEveryCycleFromTheFirstMotionOn) {
  options_.record_file = testing::TempDir() + "runner_record.csv";
  appliance_.handles(kMove, [&](const json& params) {
    const auto sample = [](int cycle, bool moving, double at, double measured) {
      return json{{"t_s", 0.001 * cycle},
                  {"cycle", cycle},
                  {"move_id", 1},
                  {"s_mm", 0},
                  {"feed_mm_s", 0},
                  {"moving", moving},
                  {"pose", {0, 0, 0, 0, 0, 1}},
                  {"q", {at}},
                  {"qd", {0}},
                  {"qdd", {0}},
                  {"a", {measured}}};
    };
    appliance_.push("joints",
                    {{"samples", {sample(1, false, 0, 0), sample(2, true, 1, 0.75), sample(3, false, 2, 2)}}});
    appliance_.push_event(Kind::MoveDone, {{"move_id", params.at("MoveID")}, {"t_s", 0.003}});
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->record_rows, 2U) << "standing before the first move is no part of it";
  EXPECT_TRUE(report->every_cycle_seen);
  EXPECT_THAT(report->following_error, ElementsAre(0.25));
  EXPECT_THAT(report->record_files, ElementsAre(options_.record_file));
  std::ifstream file(options_.record_file);
  const std::vector<std::string> lines{std::istream_iterator<std::string>(file), {}};
  EXPECT_THAT(lines, testing::SizeIs(3));
  EXPECT_EQ(appliance_.params_of("subscribe").back(), (json{{"topics", {"joints"}}, {"rate_hz", 1e6}}));
}

TEST_F(RunnerTest, FailsWhereTheRecordLacksCycles) {
  options_.record_file = testing::TempDir() + "gappy_record.csv";
  appliance_.handles(kMove, [&](const json&) {
    json samples = json::array();
    for (const int cycle : {1, 4}) {
      samples.push_back({{"t_s", 1.0},
                         {"cycle", cycle},
                         {"moving", true},
                         {"pose", {0, 0, 0, 0, 0, 1}},
                         {"q", {0}},
                         {"qd", {0}},
                         {"qdd", {0}}});
    }
    appliance_.push("joints", {{"samples", samples}});
    appliance_.push_event(Kind::MoveDone, {{"move_id", 1}, {"t_s", 1.0}});
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "the record lacks 2 cycles: another client has the full rate");
}

TEST_F(RunnerTest, MovesNothingWhenTheRecordCannotBeWritten) {
  options_.record_file = "/nonexistent/record.csv";
  move(1);
  const auto report = run();
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("/nonexistent/record.csv: the record cannot be written"));
  EXPECT_THAT(appliance_.methods(), IsEmpty());
}

}  // namespace
}  // namespace rmac::cli
