#include <gmock/gmock.h>

#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const json kUnknown{{"state", "unknown"}, {"transmit_errors", nullptr}, {"receive_errors", nullptr}};

json bus_with(json nodes, json controller = kUnknown) {
  const json bus{{"interface", "can0"},
                 {"cycles", 1000},
                 {"unsent", 0},
                 {"short_answers", 0},
                 {"sent", 3000},
                 {"received", 2999},
                 {"queue_full", 0},
                 {"send_failures", 0},
                 {"overflowed", 0},
                 {"error_frames", 2},
                 {"warnings", 5},
                 {"passives", 4},
                 {"controller", std::move(controller)},
                 {"bus_offs", 1},
                 {"bus_off", false},
                 {"link_down", false},
                 {"nodes", std::move(nodes)}};
  return {{"buses", {bus}}, {"lines", json::array()}};
}

TEST_F(CommandBench, BusStateTellsEachNodeAndItsHistory) {
  appliance_.answers(
      "Bus.GetState",
      bus_with(
          {{{"node", 3},
            {"axes", {0, 1}},
            {"state", "awaiting boot-up"},
            {"problem", "node 3 (axis 0, 1) sent no heartbeat"},
            {"lost", 1},
            {"recovered", 0},
            {"missed_answers", 7},
            {"answers", 900},
            {"jitter_mean_s", 12.5e-6},
            {"jitter_most_s", 80e-6},
            {"emergency_count", 1},
            {"emergencies", {{{"code", 0x8611}, {"text", "following error"}, {"error_register", 0x21}, {"age_s", 4}}}},
            {"abort_count", 1},
            {"aborts", {{{"index", 0x6502}, {"sub", 0}, {"code", 0x06020000}, {"text", "no such object"}}}}}}));
  const auto told = run({"bus", "state"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  for (const char* words :
       {"can0: 1000 cycles, 3000 frames sent, 2999 received", "5 times error-warning, 4 error-passive, 1 bus-off",
        "0, 1", "12.5", "node 3: node 3 (axis 0, 1) sent no heartbeat",
        "node 3: EMCY 8611h (following error), error register 21h, 4 s ago",
        "node 3: refused 6502h:00: no such object (06020000h)"}) {
    EXPECT_THAT(told.out, HasSubstr(words));
  }
  EXPECT_EQ(json::parse(run({"--json", "bus", "state"}).out)["buses"][0]["nodes"][0]["missed_answers"], 7);
}

TEST_F(CommandBench, BusStateTellsTheControllerAsFarAsItsInterfaceDoes) {
  const auto told_of = [this](const json& controller) {
    appliance_.answers("Bus.GetState", bus_with(json::array(), controller));
    return run({"bus", "state"}).out;
  };
  EXPECT_THAT(told_of({{"state", "error-passive"}, {"transmit_errors", 128}, {"receive_errors", 3}}),
              HasSubstr("controller error-passive, error counters 128 transmit, 3 receive\n"));
  EXPECT_THAT(told_of({{"state", "bus-off"}, {"transmit_errors", nullptr}, {"receive_errors", nullptr}}),
              HasSubstr("controller bus-off, error counters not told\n"));
  EXPECT_THAT(told_of(kUnknown), HasSubstr("the interface tells of no controller\n"));
}

TEST_F(CommandBench, BusStateTellsEachUnitOfAModbusLine) {
  const json unit{{"unit", 4},
                  {"state", "is busy"},
                  {"requests", 50},
                  {"answers", 30},
                  {"timeouts", 7},
                  {"wrong_answers", 2},
                  {"disconnects", 1},
                  {"exceptions", {{{"code", 2}, {"count", 3}}, {{"code", 6}, {"count", 8}}}},
                  {"last_trouble", {{"message", "slave 4: refused with exception 6: it is busy"}, {"age_s", 2.5}}}};
  const json line{{"endpoint", "127.0.0.1 port 502"}, {"rounds", 40}, {"connections", 3}, {"units", {unit}}};
  appliance_.answers("Bus.GetState", {{"buses", json::array()}, {"lines", {line}}});
  const auto told = run({"bus", "state"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  for (const char* words : {"127.0.0.1 port 502: 40 rounds, opened 3 times", "is busy", "2: 3, 6: 8",
                            "unit 4: slave 4: refused with exception 6: it is busy, 2.5 s ago"}) {
    EXPECT_THAT(told.out, HasSubstr(words));
  }
}

TEST_F(CommandBench, BusStateShowsWhatAFlightRecordKept) {
  const json report = bus_with(json::array(), {{"state", "bus-off"}, {"transmit_errors", 256}, {"receive_errors", 0}});
  const auto holds = [this](const json& head) {
    appliance_.answers("FlightRecorder.Read", {{"text", head.dump() + "\nt_s,q1\n1,2\n"}, {"next_offset", nullptr}});
  };
  holds({{"name", "r-1"}, {"buses", report}});
  const auto told = run({"bus", "state", "--record", "r-1"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("controller bus-off, error counters 256 transmit, 0 receive"));
  EXPECT_EQ(json::parse(run({"--json", "bus", "state", "--record", "r-1"}).out), report);
  EXPECT_EQ(appliance_.params_of("FlightRecorder.Read").front().at("Name"), "r-1");
  for (const json& older : {json{{"name", "r-1"}}, json{{"name", "r-1"}, {"buses", nullptr}}, json("no head")}) {
    holds(older);
    EXPECT_THAT(run({"bus", "state", "--record", "r-1"}).err,
                HasSubstr("flight record r-1 tells nothing of buses; records of earlier versions do not"));
  }
}

TEST_F(CommandBench, BusStateSaysThatNoBusRuns) {
  appliance_.answers("Bus.GetState", {{"buses", json::array()}, {"lines", json::array()}});
  EXPECT_EQ(run({"bus", "state"}).out, "no CANopen bus and no Modbus line runs\n");
  EXPECT_NE(run_at("/nonexistent/socket", {"bus", "state"}).exit_code, 0) << "it asks the appliance";
}

}  // namespace
}  // namespace rmac::cli
