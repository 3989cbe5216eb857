// The record that a run writes.
#include <fstream>

#include "unit/gateway/rmac/program/runner_bench.hpp"

namespace rmac::cli {
namespace {

using gateway::Answer;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = gateway::Event::Kind;

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
                  {"a", {measured}},
                  {"error", {at == 1 ? -0.25 : 0.125}}};
    };
    appliance_.push("joints", {{"samples", {sample(1, false, 0, 0), sample(2, true, 1, 0), sample(3, false, 2, 1)}}});
    appliance_.push_event(Kind::MoveDone, {{"move_id", params.at("MoveID")}, {"t_s", 0.003}});
    return Answer(true);
  });
  move(1);
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->record_rows, 2U) << "standing before the first move is no part of it";
  EXPECT_TRUE(report->every_cycle_seen);
  EXPECT_THAT(report->following_error, ElementsAre(0.25))
      << "as the appliance has it, whose drives answer a cycle late";
  EXPECT_THAT(report->record_files, ElementsAre(options_.record_file));
  std::ifstream file(options_.record_file);
  const std::vector<std::string> lines{std::istream_iterator<std::string>(file), {}};
  EXPECT_THAT(lines, ElementsAre(testing::EndsWith("q1,qd1,qdd1,a1,error1"), testing::EndsWith(",1,0,0,0,-0.25"),
                                 testing::EndsWith(",2,0,0,1,0.125")));
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
