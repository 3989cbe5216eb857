// What needs another appliance than the client's own; programs as a user runs them are in tests/system.
#include "gateway/rmac/simulator/simulator.hpp"

#include <gmock/gmock.h>

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

TEST(Simulator, DoesNotRunAQueueThatItsProgramNeverStarts) {
  Program program = strokes(2);
  program.starts_cycle = true;
  const auto report = simulate(std::move(program), 100);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, testing::HasSubstr("strokes.rmac: the program ends without starting its cycle"));
}

}  // namespace
}  // namespace rmac::cli
