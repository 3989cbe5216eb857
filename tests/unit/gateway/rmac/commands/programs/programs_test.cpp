// rmac run and rmac simulate: their words, and what they tell. How a program runs is in program/runner_test.cpp.
#include <gmock/gmock.h>

#include <fstream>

#include "places.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;

class ProgramCommands : public CommandBench {
 protected:
  ProgramCommands() {
    std::ofstream(file_) << R"({"method":"RMAC_CAM.SetFeedrate","params":{"Feedrate":600}})"
                         << "\n"
                         << R"({"method":"RMAC_CAM.MoveToPathTarget","params":{"MoveID":1,"TargetFrame":)"
                         << R"({"p":[1,0,0],"axis":[0,0,1]}}})"
                         << "\n";
    appliance_.handles("RMAC_CAM.MoveToPathTarget", [this](const json& params) {
      using Kind = gateway::Event::Kind;
      appliance_.push(
          "joints", {{"samples", {{{"t_s", 1.0}, {"moving", true}, {"q", {1.0}}, {"a", {0.5}}, {"error", {-0.25}}}}}});
      appliance_.push_event(Kind::MoveStarted, {{"move_id", params.at("MoveID")}, {"t_s", 1.0}});
      appliance_.push_event(Kind::MoveDone, {{"move_id", params.at("MoveID")}, {"t_s", 1.5}});
      return gateway::Answer(true);
    });
  }

  const std::string file_ = testing::TempDir() + "programs_test.rmac";
};

TEST_F(ProgramCommands, RunTellsHowLongItTookByTheMachinesClock) {
  const auto shown = run({"run", file_});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  // How wide the columns are depends on the time that it took.
  EXPECT_THAT(shown.out, ContainsRegex("requests +2\n"));
  EXPECT_THAT(shown.out, ContainsRegex("moves +1\n"));
  EXPECT_THAT(shown.out, ContainsRegex("cycle time +0.5  s\n"));
  EXPECT_THAT(shown.out, ContainsRegex("following error, joint 0 +0.25  mm or deg, of samples\n"));
}

TEST_F(ProgramCommands, RunPrintsForPrograms) {
  const json report = json::parse(run({"run", file_, "--json"}).out);
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_EQ(report.at("moves"), 1);
  EXPECT_EQ(report.at("cycle_time_s"), 0.5);
  EXPECT_EQ(report.at("following_error"), json{0.25});
  EXPECT_EQ(report.at("following_error_of_every_cycle"), false);
}

TEST_F(ProgramCommands, RunLoadsTheMachineThatIsNamed) {
  ASSERT_EQ(run({"run", file_, "--machine", "Mill", "--virtual"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("Device.Load"), testing::ElementsAre(json{{"Name", "Mill"}, {"Virtual", true}}));
}

TEST_F(ProgramCommands, RunMovesNothingForAProgramThatCannotBeRead) {
  std::ofstream(file_) << "G1 X5\n";
  const auto failed = run({"run", file_});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("programs_test.rmac:1: "));
  EXPECT_THAT(appliance_.methods(), testing::IsEmpty());
}

TEST_F(ProgramCommands, RunRefusesAFileWhoseLanguageNothingTells) {
  const auto failed = run({"run", "part.gcode"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("part.gcode: its ending tells no language"));
  EXPECT_THAT(failed.err, HasSubstr("--dialect"));
  EXPECT_THAT(run({"run", file_, "--rapid", "900"}).err, HasSubstr("programs_test.rmac: is taken as .rmac"));
  EXPECT_THAT(appliance_.methods(), testing::IsEmpty());
}

TEST_F(ProgramCommands, RunFailsByWhatTheMachineRefuses) {
  appliance_.refuses("RMAC_CAM.MoveToPathTarget", -32004, "out of reach");
  const auto failed = run({"run", file_});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("programs_test.rmac:2: RMAC_CAM.MoveToPathTarget: out of reach\n"));
}

TEST_F(ProgramCommands, SimulateTellsWhatTheMachineWouldDo) {
  const auto shown =
      run({"--json", "simulate", file_, "--machine", "BenchXYZ", "--device-tree", RMAC_BINARY_DIR "/drivers"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const json report = json::parse(shown.out);
  EXPECT_EQ(report.at("moves"), 1);
  EXPECT_NEAR(report.at("length_mm").get<double>(), 1, 1e-9);
  EXPECT_GT(report.at("cycle_time_s").get<double>(), 0.1) << "1 mm at 600 mm/min";
  EXPECT_EQ(report.at("collisions"), "not checked");
  EXPECT_THAT(appliance_.methods(), testing::IsEmpty());
}

TEST_F(ProgramCommands, SimulateNeedsAMachine) {
  const auto failed = run({"simulate", file_});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("the program loads no machine; name one with --machine"));
  EXPECT_THAT(run({"simulate", file_, "--machine", "NoSuchMachine", "--device-tree", RMAC_BINARY_DIR "/drivers"}).err,
              HasSubstr("NoSuchMachine"));
}

TEST_F(ProgramCommands, SimulateTakesThePeriodsOfAServoLoop) {
  EXPECT_EQ(run({"simulate", file_, "--period", "0.00009"}).exit_code, 2);
  EXPECT_EQ(run({"simulate", file_, "--period", "0.11"}).exit_code, 2);
  EXPECT_EQ(run({"simulate", file_, "--tools", "/nonexistent"}).exit_code, 2);
  EXPECT_EQ(run({"simulate"}).exit_code, 2);
  EXPECT_EQ(run({"run"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
