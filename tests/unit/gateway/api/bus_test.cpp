// What Bus.GetState tells.
#include <gtest/gtest.h>

#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using nlohmann::json;

fieldbus::BusReport can_bus() {
  fieldbus::BusReport bus;
  bus.interface = "can0";
  bus.health.passives = 3;
  return bus;
}

TEST(BusApi, TellsTheControllerAndNullWhatItsInterfaceDoesNotTell) {
  Api api;
  fieldbus::BusReport told = can_bus(), silent = can_bus();
  told.controller = {fieldbus::CanController::State::ErrorPassive, {{.transmit = 130, .receive = 7}}};
  api.machine.buses.can = {told, silent};
  const json buses = api.result("Bus.GetState").at("buses");
  EXPECT_EQ(buses.at(0).at("passives"), 3);
  EXPECT_EQ(buses.at(0).at("controller"),
            (json{{"state", "error-passive"}, {"transmit_errors", 130}, {"receive_errors", 7}}));
  EXPECT_EQ(buses.at(1).at("controller"),
            (json{{"state", "unknown"}, {"transmit_errors", nullptr}, {"receive_errors", nullptr}}));
}

TEST(BusApi, TellsEachUnitOfALineByItself) {
  Api api;
  fieldbus::modbus::UnitReport busy{4, "is busy", {}}, sound{5, "answers", {}};
  busy.traffic.requests = 9;
  busy.traffic.timeouts = 1;
  busy.traffic.exceptions = {{2, 3}, {6, 5}};
  busy.traffic.last_trouble = {"it is busy", 0.5};
  sound.traffic.answers = 8;
  api.machine.buses.modbus = {{"127.0.0.1 port 502", 40, 2, {busy, sound}}};
  const json line = api.result("Bus.GetState").at("lines").at(0);
  EXPECT_EQ(line.at("endpoint"), "127.0.0.1 port 502");
  EXPECT_EQ(line.at("connections"), 2);
  const json first = line.at("units").at(0), second = line.at("units").at(1);
  EXPECT_EQ(first.at("unit"), 4);
  EXPECT_EQ(first.at("timeouts"), 1);
  EXPECT_EQ(first.at("exceptions"), json::parse(R"([{"code": 2, "count": 3}, {"code": 6, "count": 5}])"));
  EXPECT_EQ(first.at("last_trouble"), (json{{"message", "it is busy"}, {"age_s", 0.5}}));
  EXPECT_EQ(second.at("answers"), 8);
  EXPECT_EQ(second.at("exceptions"), json::array());
  EXPECT_TRUE(second.at("last_trouble").is_null());
}

}  // namespace
}  // namespace rmac::gateway
