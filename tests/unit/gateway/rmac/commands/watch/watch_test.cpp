#include <gmock/gmock.h>

#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class StatusCommand : public CommandBench {
 protected:
  void tells(const json& members) {
    appliance_.handles("subscribe", [this, members](const json&) {
      appliance_.push("state", state(members));
      return gateway::Answer(true);
    });
  }
};
using CyclesCommand = CommandBench;
using EventsCommand = CommandBench;

TEST_F(StatusCommand, ShowsTheStateOnce) {
  tells({{"state", "Running"}, {"moving", true}, {"move_id", 12}, {"status_minor", 10}, {"override_percent", 80}});
  const auto shown = run({"status"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("machine           BenchXYZ"));
  EXPECT_THAT(shown.out, HasSubstr("cycle             Running, moving"));
  EXPECT_THAT(shown.out, HasSubstr("override          80"));
  EXPECT_THAT(shown.out, HasSubstr("last error        MACHINE_ERR_UNEXPECTED_HIT"));
  EXPECT_THAT(shown.out, HasSubstr("operator          nobody"));
  EXPECT_THAT(appliance_.params_of("subscribe"), ElementsAre(json{{"topics", {"state"}}, {"rate_hz", 5.0}}));
}

TEST_F(StatusCommand, SaysWhatStoppedTheMachineAndWhatToDo) {
  tells({{"state", "Faulted"},
         {"t_s", 61.5},
         {"last_stop", {{"kind", "Fault"}, {"cycle", 7}, {"t_s", 1.5}, {"message", "late"}, {"record", "r-1"}}}});
  EXPECT_THAT(run({"status"}).out,
              HasSubstr("\nlast stop (Fault), 60 s ago: cycle 7, 1.5 s: late\nflight record r-1: rmac trace plot r-1\n"
                        "to go on, its cause removed: rmac reset\n"));
}

TEST_F(StatusCommand, SaysWhenTheLastErrorWasAndWhatClearsIt) {
  tells({{"t_s", 10.0},
         {"status_minor", 4},
         {"last_error", {{"status_minor", 4}, {"t_s", 2.5}, {"message", "Home: X is beyond its limit"}}}});
  EXPECT_THAT(run({"status"}).out,
              HasSubstr("\nlast error, 7.5 s ago: Home: X is beyond its limit\nto clear it: rmac reset\n"));
}

TEST_F(StatusCommand, SaysWhoHoldsTheMachine) {
  tells({{"state", "Idle"}, {"held_by", "panel (TCP client 3)"}, {"operator", "other"}, {"override_percent", 100}});
  const auto held = run({"status"});
  EXPECT_THAT(held.out, HasSubstr("\npanel (TCP client 3) holds the machine; to go on: rmac resume\n"));
  EXPECT_THAT(held.out, HasSubstr("operator          other"));
}

TEST_F(StatusCommand, SaysWhyARunningMachineRefusesAJog) {
  tells({{"state", "Running"}, {"waits_for", "moves"}});
  EXPECT_THAT(run({"status"}).out, HasSubstr("waits for moves, so jog and home are refused; to end it: rmac stop\n"));
}

TEST_F(StatusCommand, SaysHowFarAheadMotionIsPlannedAndWhyNoFurther) {
  tells({{"state", "Running"}, {"horizon_s", 0.0314}, {"horizon_limit", "queue"}});
  EXPECT_THAT(run({"status"}).out, HasSubstr("planned ahead     31 ms, queue\n"));
}

TEST_F(StatusCommand, PrintsForProgramsWhatWasPushed) {
  tells({{"move_id", 5}});
  EXPECT_EQ(json::parse(run({"status", "--json"}).out), state({{"move_id", 5}}));
}

TEST_F(CyclesCommand, ShowsWhereTheTimeGoes) {
  const json times{{"count", 1000},  {"median_us", 1.0},   {"p99_us", 2.0},
                   {"p999_us", 3.5}, {"largest_us", 70.0}, {"bins", {{1.5, 900}, {1.9, 99}, {70.0, 1}}}};
  appliance_.answers("RMAC_CAM.GetCycleTimes",
                     {{"deadline_misses", 2}, {"wake_up", times}, {"compute", times}, {"bus", times}});
  const auto shown = run({"cycles"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("after it was due    1000       1     2     3.5"));
  EXPECT_THAT(shown.out, HasSubstr("< 2 µs          999  ##################\n")) << "one decade is six marks";
  EXPECT_THAT(shown.out, HasSubstr("< 128 µs            1  #\n")) << "one cycle in a thousand is to be seen";
  EXPECT_THAT(shown.out, testing::EndsWith("2 deadlines missed\n"));
}

TEST_F(EventsCommand, AreToldUntilTheConnectionEnds) {
  appliance_.handles("subscribe", [&](const json&) {
    using Kind = gateway::Event::Kind;
    appliance_.push_event(Kind::MoveDone, {{"t_s", 2.5}, {"cycle", 2500}, {"move_id", 9}, {"message", ""}});
    appliance_.push("state", state());
    appliance_.push_event(Kind::Fault, {{"t_s", 3.0}, {"cycle", 3000}, {"message", "late"}, {"record", "r-2"}});
    appliance_.hang_up_behind_this();
    return gateway::Answer(true);
  });
  const auto ended = run({"events"});
  EXPECT_EQ(ended.out,
            "         2.5        2500  MoveDone          move 9  \n"
            "           3        3000  Fault             late; flight record r-2\n");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.err, HasSubstr(" ended: "));
}

}  // namespace
}  // namespace rmac::cli
