#include "gateway/buses/report/bus_changes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using fieldbus::FieldbusReport;
using testing::ElementsAre;
using testing::IsEmpty;

/// One bus with one node, and one line with one unit.
FieldbusReport report() {
  fieldbus::BusReport bus;
  bus.interface = "can0";
  bus.cycles = 100;
  bus.nodes.emplace_back().node = 5;
  bus.nodes.back().state = "operational";
  return {{bus}, {{"/dev/ttyS0", 10, 1, {{2, "answers", {}}}}}};
}

TEST(BusChanges, TellTheLatestOfWhatANodeRefusedAndReported) {
  const FieldbusReport before = report();
  FieldbusReport now = report();
  auto& node = now.can[0].nodes[0];
  node.abort_count = 2;
  node.aborts = {{{0x6060, 0}, 0x06020000, "no such object"}, {{0x607A, 0}, 0x06010002, "read only"}};
  node.emergency_count = 3;
  node.emergencies = {{0x8130, "heartbeat", 0x11, 0}, {0x2310, "over-current", 0x03, 1}};
  EXPECT_THAT(
      changes_between(before, now),
      ElementsAre(BusChange{"can0 node 5 EMCY", "can0 node 5: EMCY 8130h (heartbeat), error register 11h", 3},
                  BusChange{"can0 node 5 SDO", "can0 node 5: refused 6060h:00: no such object (06020000h)", 2}));
}

TEST(BusChanges, TellHowAControllerFaresAndHowOftenWhereItIsKnown) {
  using State = fieldbus::CanController::State;
  FieldbusReport before = report(), now = report();
  before.can[0].controller.state = State::ErrorActive;
  now.can[0].controller.state = State::ErrorPassive;
  const std::string went =
      fmt::format("can0: controller {}, after {}", to_string(State::ErrorPassive), to_string(State::ErrorActive));
  EXPECT_THAT(changes_between(before, now), ElementsAre(BusChange{"can0 controller", went}));
  now.can[0].health.warnings = 2;
  now.can[0].health.passives = 1;
  EXPECT_THAT(
      changes_between(before, now),
      ElementsAre(BusChange{"can0 controller", went + "; 2 times error-warning, 1 error-passive, 0 bus-off since"}));
}

TEST(BusChanges, AreOfBusesThatWentOnOrStandAndOfNoneThatBeganAnew) {
  const FieldbusReport before = report();
  for (const int later : {-1, 0, 1}) {
    FieldbusReport now = report();
    now.can[0].cycles = static_cast<std::uint64_t>(100 + later);
    now.can[0].nodes[0].state = "stopped";
    now.modbus[0].rounds = static_cast<std::uint64_t>(10 + later);
    now.modbus[0].units[0].state = "is busy";
    EXPECT_EQ(changes_between(before, now).size(), later < 0 ? 0U : 2U) << later;
  }
}

TEST(BusChanges, AreOfWhatWasThereBefore) {
  FieldbusReport now = report();
  now.can[0].nodes[0].node = 6;
  now.can[0].nodes[0].lost = now.can[0].nodes[0].recovered = 3;
  now.modbus[0].units[0] = {3, "does not answer", {}};
  EXPECT_THAT(changes_between(report(), now), IsEmpty());
  now.can[0].interface = "can1";
  now.modbus[0].endpoint = "/dev/ttyS1";
  EXPECT_THAT(changes_between(report(), now), IsEmpty());
}

}  // namespace
}  // namespace rmac::gateway
