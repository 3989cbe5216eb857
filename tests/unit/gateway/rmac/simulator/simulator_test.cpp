// What needs another appliance than the client's own; programs as a user runs them are in tests/system.
#include "gateway/rmac/simulator/simulator.hpp"

#include <gmock/gmock.h>

#include <random>

#include "places.hpp"

namespace rmac::cli {
namespace {

Request request(int line, const std::string& method, const nlohmann::json& params) {
  Request made{line, nlohmann::json{{"method", method}, {"params", params}}.dump(), method, timing_of(method)};
  if (made.timing == Timing::Move) made.move_id = params.at("MoveID");
  return made;
}

Program strokes(int count) {
  Program program;
  program.file = "strokes.rmac";
  program.requests.push_back(request(1, "RMAC_CAM.SetFeedrate", {{"Feedrate", 6000}}));
  for (int i = 1; i <= count; ++i) {
    const nlohmann::json target{{"p", {i % 2 == 1 ? 1 : 0, 0, 0}}, {"axis", {0, 0, 1}}};
    program.requests.push_back(request(i + 1, "RMAC_CAM.MoveToPathTarget", {{"MoveID", i}, {"TargetFrame", target}}));
  }
  return program;
}

Result<SimulationReport> simulate(const Program& program, std::size_t queue_capacity) {
  auto simulation = gateway::Simulation::open(
      {.device_tree = RMAC_BINARY_DIR "/drivers", .queue_capacity = queue_capacity}, "BenchXYZ");
  if (!simulation) return fail(simulation.error().message);
  return Simulator(**simulation, program, "").run();
}

TEST(Simulator, WaitsForRoomInTheQueue) {
  const auto narrow = simulate(strokes(20), 3);
  ASSERT_TRUE(narrow) << narrow.error().message;
  const auto wide = simulate(strokes(20), 100);
  ASSERT_TRUE(wide) << wide.error().message;
  EXPECT_EQ(narrow->moves, 20U);
  EXPECT_NEAR(narrow->length_mm, 20, 1e-9);
  EXPECT_NEAR(narrow->cycle_time_s, wide->cycle_time_s, 0.02) << "no stroke waited for long";
}

// Red when a dwell takes no time or is taken for a machine that is stuck, or when a stop waits for a person.
TEST(Simulator, CountsDwellsAndPassesStopsAndInputs) {
  const auto plain = simulate(strokes(2), 100);
  ASSERT_TRUE(plain) << plain.error().message;
  Program program = strokes(2);
  const auto last = program.requests.back();
  program.requests.pop_back();
  program.requests.push_back(request(3, "RMAC_CAM.Dwell", {{"MoveID", 10}, {"Time", 2.5}}));
  program.requests.push_back(request(4, "RMAC_CAM.ProgramStop", {{"MoveID", 11}, {"Message", "look"}}));
  program.requests.push_back(request(5, "RMAC_CAM.ProgramStop", {{"MoveID", 12}, {"Optional", true}}));
  program.requests.push_back(last);
  program.requests.push_back(request(7, "RMAC_CAM.Dwell", {{"MoveID", 13}, {"Time", 0.5}}));
  const auto report = simulate(program, 100);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_NEAR(report->cycle_time_s, plain->cycle_time_s + 3, 0.05);
  EXPECT_EQ(report->moves, 6U) << "each is done";
  EXPECT_NEAR(report->length_mm, 2, 1e-9);
}

// Red when a move to where the tool stands is told done before the dwell in front of it: the end is waited for for
// ever.
TEST(Simulator, PassesAMoveToWhereTheToolStandsBehindADwell) {
  Program program = strokes(1);
  const nlohmann::json there{{"p", {1, 0, 0}}, {"axis", {0, 0, 1}}};
  program.requests.push_back(request(3, "RMAC_CAM.Dwell", {{"MoveID", 10}, {"Time", 0.5}}));
  program.requests.push_back(request(4, "RMAC_CAM.MoveToPathTarget", {{"MoveID", 11}, {"TargetFrame", there}}));
  const auto report = simulate(program, 100);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->moves, 3U);
}

// Red when one of two steps that are done in the same cycle is told before the one in front of it, whatever they are.
TEST(Simulator, GetsThroughWhateverStandsBetweenMoves) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    Program program;
    program.file = "steps.rmac";
    program.requests.push_back(request(1, "RMAC_CAM.SetFeedrate", {{"Feedrate", 6000}}));
    int place = 0;
    for (int i = 1; i <= 40; ++i) {
      const auto add = [&](const std::string& method, nlohmann::json params) {
        params["MoveID"] = i;
        program.requests.push_back(request(i + 1, method, params));
      };
      switch (random() % 5) {
        case 0:
          place = 1 - place;
          [[fallthrough]];
        case 1:
          add("RMAC_CAM.MoveToPathTarget", {{"TargetFrame", {{"p", {place, 0, 0}}, {"axis", {0, 0, 1}}}}});
          break;
        case 2:
          add("RMAC_CAM.Dwell", {{"Time", random() % 2 == 0 ? 0 : 0.004}});
          break;
        case 3:
          add("RMAC_CAM.ProgramStop", {{"Optional", random() % 2 == 0}});
          break;
        default:
          add("RMAC_CAM.InTurn", {{"Calls",
                                   {{{"method", "RMAC_CAM.SetSpindleRPM"},
                                     {"params", {{"SpindleNumber", 0}, {"RPM", 100 * (random() % 3)}}}}}}});
      }
    }
    const auto report = simulate(program, 100);
    ASSERT_TRUE(report) << "seed " << seed << ": " << report.error().message;
    EXPECT_EQ(report->moves, 40U) << "seed " << seed;
  }
}

TEST(Simulator, NamesTheLineOfAnInputThatIsNot) {
  Program program = strokes(1);
  program.requests.push_back(
      request(9, "RMAC_CAM.AwaitInput", {{"MoveID", 10}, {"Name", "Clampd"}, {"On", true}, {"TimeOut", 1}}));
  const auto report = simulate(program, 100);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message,
              testing::HasSubstr("strokes.rmac:9: RMAC_CAM.AwaitInput: AwaitInput: there is no"));
}

TEST(Simulator, DoesNotRunAQueueThatItsProgramNeverStarts) {
  Program program = strokes(2);
  program.starts_cycle = true;
  const auto report = simulate(std::move(program), 100);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, testing::HasSubstr("strokes.rmac: the program ends without starting its cycle"));
}

}  // namespace
}  // namespace rmac::cli
