// What is told of buses, from reports and a clock that the test makes.
#include "gateway/buses/report/bus_watch.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace rmac::gateway {
namespace {

using fieldbus::FieldbusReport;
using fieldbus::NodeReport;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using ControllerState = fieldbus::CanController::State;

class BusWatchTest : public testing::Test {
 protected:
  BusWatchTest() {
    fieldbus::BusReport bus;
    bus.interface = "can0";
    bus.controller.state = ControllerState::ErrorActive;
    for (const auto node : {std::uint8_t{3}, std::uint8_t{4}}) {
      NodeReport& told = bus.nodes.emplace_back();
      told.node = node;
      told.state = "operational";
    }
    report_.can = {bus};
    report_.modbus = {{"127.0.0.1 port 502", 0, 1, {{1, "answers", {}}}}};
  }
  NodeReport& node(std::size_t place = 0) { return report_.can[0].nodes[place]; }
  void emergency(std::uint16_t code, const char* text) {
    ++node().emergency_count;
    auto& kept = node().emergencies;
    kept.insert(kept.begin(), {code, text, 0x21, 0});
    if (kept.size() > 8) kept.pop_back();
  }
  std::vector<std::string> look(double now_s) {
    report_.can[0].cycles += 500;
    report_.modbus[0].rounds += 10;
    return watch_.look(report_, now_s);
  }

  FieldbusReport report_;
  BusWatch watch_;
};

TEST_F(BusWatchTest, TellsNothingOfTheFirstReportAndNothingWhereNothingChanges) {
  node().state = "failed";
  emergency(0x8611, "following error");
  EXPECT_THAT(look(0), IsEmpty());
  EXPECT_THAT(look(0.5), IsEmpty());
}

TEST_F(BusWatchTest, LooksEveryHalfSecondAndAtOnceAfterAnotherMachineWentIn) {
  EXPECT_TRUE(watch_.due(7));
  (void)look(7);
  EXPECT_FALSE(watch_.due(7.4));
  EXPECT_TRUE(watch_.due(7.5));
  watch_.forget();
  EXPECT_TRUE(watch_.due(7.1));
  EXPECT_THAT(watch_.summary(), IsEmpty());
  emergency(0x8611, "following error");
  EXPECT_THAT(look(7.1), IsEmpty()) << "the first one after a load";
}

TEST_F(BusWatchTest, ABusThatWasBroughtUpAnewBeginsAnew) {
  (void)look(0);
  report_.can[0].cycles = 0;
  report_.modbus[0].rounds = 0;
  node().state = "awaiting boot-up";
  emergency(0x8611, "following error");
  report_.modbus[0].units[0].state = "is busy";
  report_.can[0].cycles -= 500;
  report_.modbus[0].rounds -= 10;
  EXPECT_THAT(look(0.5), IsEmpty());
}

TEST_F(BusWatchTest, TellsWhatBefellANode) {
  (void)look(0);
  node().state = "awaiting boot-up";
  node().problem = "it sent no heartbeat";
  node().missed_answers = 7;
  emergency(0x1000, "generic");
  emergency(0x8611, "following error");
  node().abort_count = 1;
  node().aborts = {{{0x6502, 0}, 0x06020000, "no such object"}};
  EXPECT_THAT(look(0.5), ElementsAre("can0 node 3: awaiting boot-up, after operational: it sent no heartbeat",
                                     "can0 node 3: left SYNCs unanswered: 7",
                                     "can0 node 3: EMCY 8611h (following error), error register 21h; 1 more before it",
                                     "can0 node 3: refused 6502h:00: no such object (06020000h)"));
}

TEST_F(BusWatchTest, TellsOfANodeThatWasLostAndCameBackBetweenTwoLooks) {
  (void)look(0);
  node().lost = node().recovered = 1;
  EXPECT_THAT(look(0.5), ElementsAre("can0 node 3: was lost and came back"));
}

TEST_F(BusWatchTest, TellsHowTheControllerFares) {
  (void)look(0);
  report_.can[0].controller.state = ControllerState::ErrorPassive;
  report_.can[0].health.passives = 1;
  EXPECT_THAT(look(0.5), ElementsAre("can0: controller error-passive, after error-active; 0 times error-warning, 1 "
                                     "error-passive, 0 bus-off since"));
  report_.can[0].health.link_down = true;
  EXPECT_THAT(look(1), ElementsAre("can0: the interface is down")) << "another kind";
}

TEST_F(BusWatchTest, TellsOfAUnitThatWentMuteAndOfItsReturn) {
  (void)look(0);
  auto& unit = report_.modbus[0].units[0];
  unit.state = "does not answer";
  unit.traffic.last_trouble = {"slave 1: no answer within 100 ms", 0.1};
  EXPECT_THAT(look(0.5), ElementsAre("127.0.0.1 port 502 unit 1: does not answer, after it answers: slave 1: no answer "
                                     "within 100 ms"));
  EXPECT_EQ(watch_.summary()[1],
            nlohmann::json::parse(R"({"name": "127.0.0.1 port 502", "controller": null, "nodes_bad": [1]})"));
  unit.state = "answers";
  EXPECT_THAT(look(1), IsEmpty()) << "told within five seconds of the other, and no later than after them";
  EXPECT_THAT(look(5.5), ElementsAre("127.0.0.1 port 502 unit 1: answers, after it does not answer"));
}

TEST_F(BusWatchTest, SumsUpWhatIsWrongNow) {
  (void)look(0);
  EXPECT_EQ(watch_.summary()[0],
            nlohmann::json::parse(R"({"name": "can0", "controller": "error-active", "nodes_bad": []})"));
  node(1).state = "failed";
  (void)look(0.5);
  EXPECT_EQ(watch_.summary()[0]["nodes_bad"], nlohmann::json::parse("[4]"));
}

TEST_F(BusWatchTest, CountersThatBeganAnewAreNoHugeNumbers) {
  report_.can[0].health.passives = 7;
  (void)look(0);
  report_.can[0].health.passives = 1;
  EXPECT_THAT(look(0.5), ElementsAre(HasSubstr("1 error-passive")));
}

/// Every EMCY is told or counted, and none of a node's is told within five seconds of the one before.
TEST_F(BusWatchTest, KeepsTheRateAndLosesNoCount) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 draw(seed);
    watch_.forget();
    (void)look(0);
    std::uint64_t sent = 0, told = 0;
    double last_s = -100;
    for (int step = 1; step <= 200; ++step) {
      const double now_s = 0.5 * step;
      // None come in the last ten seconds, so that what was kept back is told.
      const unsigned count = step > 180 || draw() % 3 != 0 ? 0 : draw() % 4;
      for (unsigned i = 0; i < count; ++i) emergency(0x8611, "following error");
      sent += count;
      const auto messages = look(now_s);
      ASSERT_LE(messages.size(), 1U) << "seed " << seed;
      if (messages.empty()) continue;
      ASSERT_GE(now_s - last_s, BusWatch::kBetweenMessages_s) << "seed " << seed;
      last_s = now_s;
      const auto more = messages[0].find("h; ");
      told += 1 + (more == std::string::npos ? 0 : std::stoull(messages[0].substr(more + 3)));
    }
    ASSERT_EQ(told, sent) << "seed " << seed;
  }
}

TEST_F(BusWatchTest, OneNodesNoiseSilencesNoOther) {
  (void)look(0);
  emergency(0x8611, "following error");
  EXPECT_EQ(look(0.5).size(), 1U);
  emergency(0x8611, "following error");
  ++node(1).emergency_count;
  node(1).emergencies = {{0x3210, "DC link overvoltage", 4, 0}};
  EXPECT_THAT(look(1), ElementsAre(HasSubstr("can0 node 4: EMCY 3210h")));
}

}  // namespace
}  // namespace rmac::gateway
