#include "gateway/buses/report/bus_report_json.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

using nlohmann::json;

fieldbus::NodeReport node() {
  fieldbus::NodeReport node;
  node.node = 3;
  node.axes = {0, 2};
  node.state = "operational";
  node.problem = "its heartbeat is missing";
  node.lost = 4;
  node.recovered = 5;
  node.missed_answers = 6;
  node.answers = 7;
  node.jitter_mean_s = 0.25;
  node.jitter_most_s = 0.5;
  node.emergency_count = 8;
  node.emergencies = {{0x8130, "heartbeat", 0x11, 1.5}};
  node.abort_count = 9;
  node.aborts = {{{0x6060, 2}, 0x06020000, "no such object"}};
  return node;
}

TEST(BusReportJson, TellsAllOfACanBus) {
  fieldbus::BusReport bus;
  bus.interface = "can0";
  bus.cycles = 1;
  bus.unsent = 2;
  bus.short_answers = 3;
  bus.health = {10, 11, 12, 13, 14, 15, 16, 17, 18, true, false};
  bus.controller.errors = fieldbus::CanController::ErrorCounters{21, 22};
  bus.nodes = {node()};
  const json told = to_json(fieldbus::FieldbusReport{{bus}, {}});
  EXPECT_EQ(told.at("lines"), json::array());
  ASSERT_EQ(told.at("buses").size(), 1U);
  json expected = json::parse(R"({
    "interface": "can0", "cycles": 1, "unsent": 2, "short_answers": 3, "sent": 10, "received": 11, "queue_full": 12,
    "send_failures": 13, "overflowed": 14, "error_frames": 15, "warnings": 16, "passives": 17, "bus_offs": 18,
    "bus_off": true, "link_down": false, "controller": {"transmit_errors": 21, "receive_errors": 22},
    "nodes": [{"node": 3, "axes": [0, 2], "state": "operational", "problem": "its heartbeat is missing", "lost": 4,
      "recovered": 5, "missed_answers": 6, "answers": 7, "jitter_mean_s": 0.25, "jitter_most_s": 0.5,
      "emergency_count": 8, "emergencies": [{"code": 33072, "text": "heartbeat", "error_register": 17, "age_s": 1.5}],
      "abort_count": 9, "aborts": [{"index": 24672, "sub": 2, "code": 100794368, "text": "no such object"}]}]})");
  expected["controller"]["state"] = to_string(bus.controller.state);
  EXPECT_EQ(told.at("buses")[0], expected);
}

TEST(BusReportJson, TellsNullForWhatIsNotKnownOrNotWrong) {
  fieldbus::BusReport bus;
  bus.nodes = {node()};
  bus.nodes[0].problem.reset();
  const json told = to_json(fieldbus::FieldbusReport{{bus}, {}}).at("buses")[0];
  EXPECT_TRUE(told.at("nodes")[0].at("problem").is_null());
  EXPECT_TRUE(told.at("controller").at("transmit_errors").is_null());
  EXPECT_TRUE(told.at("controller").at("receive_errors").is_null());
}

TEST(BusReportJson, TellsAllOfAModbusLine) {
  fieldbus::modbus::LineReport line{"/dev/ttyS0", 1, 2, {}};
  fieldbus::modbus::UnitReport unit{7, "is busy", {}};
  unit.traffic = {10, 11, 12, 13, 14, {{2, 3}, {6, 4}}, fieldbus::modbus::UnitTraffic::Trouble{"no answer", 0.5}};
  line.units = {unit, {8, "answers", {}}};
  EXPECT_EQ(to_json(fieldbus::FieldbusReport{{}, {line}}), json::parse(R"({"buses": [], "lines": [
    {"endpoint": "/dev/ttyS0", "rounds": 1, "connections": 2, "units": [
      {"unit": 7, "state": "is busy", "requests": 10, "answers": 11, "timeouts": 12, "wrong_answers": 13,
       "disconnects": 14, "exceptions": [{"code": 2, "count": 3}, {"code": 6, "count": 4}],
       "last_trouble": {"message": "no answer", "age_s": 0.5}},
      {"unit": 8, "state": "answers", "requests": 0, "answers": 0, "timeouts": 0, "wrong_answers": 0,
       "disconnects": 0, "exceptions": [], "last_trouble": null}]}]})"));
}

}  // namespace
}  // namespace rmac::gateway
