#include "rmac/fieldbus/canopen/lss.hpp"

#include <random>

#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "unit/fieldbus/can/noisy_port.hpp"
#include "unit/gateway/simulators/vdrive/wire.hpp"

// CiA 305: the master's layer setting services against nodes that know nothing of it.
namespace rmac::vdrive::test {
namespace {

using fieldbus::canopen::Identity;
using fieldbus::canopen::lss_assign;
using fieldbus::canopen::lss_scan;
using fieldbus::canopen::lss_set_bit_rate;
using std::chrono::milliseconds;

class LayerSetting : public testing::Test {
 protected:
  Node& unconfigured(std::uint32_t serial) { return wire_.add(LssSlave::kUnconfigured, serial); }
  static Identity identity(std::uint32_t serial) { return {0, 0x402, 0x10000, serial}; }

  Wire wire_;
};

TEST_F(LayerSetting, FindsEveryNodeWithoutAnIdByItsIdentity) {
  std::mt19937 random(305);  // NOLINT(cert-msc51-cpp): the same numbers every time
  std::set<std::uint32_t> serials{0, 1, 0xFFFFFFFF};
  while (serials.size() < 9) serials.insert(static_cast<std::uint32_t>(random()));
  wire_.add(4);
  for (const std::uint32_t serial : serials) unconfigured(serial);
  const auto port = wire_.open();
  const auto found = lss_scan(*port);
  ASSERT_TRUE(found) << found.error().message;
  std::set<std::uint32_t> seen;
  for (const Identity& node : *found) {
    EXPECT_EQ(node.product_code, 0x402U);
    EXPECT_EQ(node.revision_number, 0x10000U);
    seen.insert(node.serial_number);
  }
  EXPECT_EQ(seen, serials);
  const auto again = lss_scan(*port);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->size(), serials.size()) << "all were left waiting";
}

TEST_F(LayerSetting, FindsNodesOfWhichEachAnswersInItsOwnTime) {
  std::uint32_t serial = 0x55AA0000;
  for (const int ms : {0, 3, 17, 40}) unconfigured(++serial).outlet().set_delay(milliseconds(ms));
  const auto found = lss_scan(*wire_.open());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->size(), 4U) << "a late answer was taken for that to the next step";
}

TEST_F(LayerSetting, FindsNobodyWhereAllHaveIds) {
  wire_.add(1);
  const auto found = lss_scan(*wire_.open());
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
  const auto refused = lss_assign(*wire_.open(), 5, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "there is no node without an id that answers a fast scan");
}

TEST_F(LayerSetting, GivesTheOnlyNodeWithoutAnIdOneThatItKeeps) {
  Node& node = unconfigured(77);
  wire_.add(4);
  const auto given = lss_assign(*wire_.open(), 9, {});
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->identity.serial_number, 77U);
  EXPECT_TRUE(given->stored);
  EXPECT_EQ(node.id(), 9);
  const auto found = fieldbus::canopen::scan_bus(*wire_.open());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  EXPECT_EQ((*found)[1].node, 9);
  EXPECT_EQ((*found)[1].identity.serial_number, 77U) << "it is the same device";
  node.power_off();
  node.power_on(Time(std::chrono::seconds(1000)));
  EXPECT_EQ(node.id(), 9);
}

TEST_F(LayerSetting, SaysThatOneOfSeveralHasToBeNamed) {
  unconfigured(1);
  Node& second = unconfigured(2);
  const auto refused = lss_assign(*wire_.open(), 9, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("several nodes without an id"), std::string::npos);
  const auto given = lss_assign(*wire_.open(), 9, identity(2));
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(second.id(), 9);
  const auto absent = lss_assign(*wire_.open(), 10, identity(3));
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message,
            "no node answers to vendor 0h, product 402h, revision 10000h, serial 3h: it is not there, or knows no LSS");
}

TEST_F(LayerSetting, GivesANodeAnotherId) {
  Node& node = wire_.add(4);
  const auto given = lss_assign(*wire_.open(), 11, identity(4));
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(node.id(), 11);
  EXPECT_EQ(node.dictionary().number(0x1014), 0x8B) << "its identifiers go with it";
}

TEST_F(LayerSetting, RefusesAnIdThatIsTakenAndABusAtWork) {
  Node& taken = wire_.add(4);
  unconfigured(1);
  const auto refused = lss_assign(*wire_.open(), 4, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "node 4 is there already; give this one another id");
  EXPECT_TRUE(taken.powered());
  const auto port = wire_.open();
  port->send(frame(0, {1, 4}));
  port->send(frame(0x604, {0x2B, 0x17, 0x10, 0, 100, 0, 0, 0}));
  const auto busy = lss_scan(*port);
  ASSERT_FALSE(busy);
  EXPECT_NE(busy.error().message.find("node 4 is operational"), std::string::npos) << busy.error().message;
}

TEST_F(LayerSetting, ChangesTheBitRateOfAllNodesTogether) {
  Node& first = wire_.add(1);
  Node& second = wire_.add(2);
  Node& third = unconfigured(3);
  const auto port = wire_.open();
  const auto done = lss_set_bit_rate(*port, {identity(1), identity(2), identity(3)}, 500'000, milliseconds(300));
  ASSERT_TRUE(done) << done.error().message;
  for (const Node* node : {&first, &second, &third}) EXPECT_EQ(node->lss().bit_rate(), 500'000U);
  const auto silent = fieldbus::canopen::scan_bus(*wire_.open(), {.listen = milliseconds(0)});
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->empty()) << "nobody speaks between two bit rates";
  wire_.pass(milliseconds(600));
  const auto after = fieldbus::canopen::scan_bus(*wire_.open());
  ASSERT_TRUE(after);
  EXPECT_EQ(after->size(), 2U);
  first.power_off();
  first.power_on(Time(std::chrono::seconds(1000)));
  EXPECT_EQ(first.lss().bit_rate(), 500'000U) << "stored";
}

TEST_F(LayerSetting, ChangesNoBitRateWhereOneNodeIsNotThere) {
  Node& first = wire_.add(1);
  const auto refused = lss_set_bit_rate(*wire_.open(), {identity(1), identity(5)}, 250'000, milliseconds(100));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("serial 5h: no node answers"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("no node changes now"), std::string::npos);
  EXPECT_EQ(first.lss().bit_rate(), 0U);
  first.power_off();
  first.power_on(Time(std::chrono::seconds(1000)));
  EXPECT_EQ(first.lss().bit_rate(), 0U);
  EXPECT_FALSE(lss_set_bit_rate(*wire_.open(), {identity(1)}, 100'000, milliseconds(100))) << "not in the table";
}

/// CiA 305, table 1.
TEST_F(LayerSetting, KnowsTheBitRatesOfTheStandardAndNoOthers) {
  Node& node = wire_.add(1);
  for (const std::uint32_t rate : {1'000'000U, 800'000U, 500'000U, 250'000U, 125'000U, 50'000U, 20'000U, 10'000U}) {
    const auto done = lss_set_bit_rate(*wire_.open(), {identity(1)}, rate, milliseconds(1));
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(node.lss().bit_rate(), rate);
    wire_.pass(milliseconds(10));
  }
  for (const std::uint32_t rate : {0U, 100'000U, 999'999U, 1'000'001U}) {
    const auto refused = lss_set_bit_rate(*wire_.open(), {identity(1)}, rate, milliseconds(1));
    ASSERT_FALSE(refused) << rate;
    EXPECT_NE(refused.error().message.find("bit rates are 10000, 20000"), std::string::npos);
  }
  EXPECT_EQ(node.lss().bit_rate(), 10'000U);
}

TEST_F(LayerSetting, TakesADelayThatTwoBytesHold) {
  wire_.add(1);
  for (const int ms : {-1, 65536}) {
    EXPECT_FALSE(lss_set_bit_rate(*wire_.open(), {identity(1)}, 500'000, milliseconds(ms))) << ms;
  }
  for (const int ms : {65535, 0}) {
    const auto done = lss_set_bit_rate(*wire_.open(), {identity(1)}, 500'000, milliseconds(ms));
    EXPECT_TRUE(done) << ms << ": " << done.error().message;
    wire_.pass(milliseconds(2 * ms + 10));
  }
  EXPECT_FALSE(lss_set_bit_rate(*wire_.open(), {}, 500'000, milliseconds(1))) << "there is nobody";
}

TEST(LayerSettingMaster, EndsWhateverFramesCome) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    fieldbus::test::NoisyPort port(seed, {0x11, 0x13, 0x17, 0x44, 0x4F, 0x5E});
    const auto found = lss_scan(port);
    if (found) {
      EXPECT_LE(found->size(), 127U);
    }
    (void)lss_assign(port, 5, {});
    (void)lss_assign(port, 5, Identity{1, 2, 3, 4});
    (void)lss_set_bit_rate(port, {Identity{1, 2, 3, 4}}, 125'000, milliseconds(10));
    EXPECT_LT(port.now(), std::chrono::hours(1));
  }
}

TEST_F(LayerSetting, StaysCalmWhateverFramesCome) {
  Node& node = unconfigured(0x12345678);
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same noise every time
  const auto port = wire_.open();
  for (int i = 0; i < 50'000; ++i) {
    CanFrame noise{.id = LssSlave::kMasterId, .size = static_cast<std::uint8_t>(random() % 9)};
    for (auto& byte : noise.data) byte = static_cast<std::uint8_t>(random());
    // Most of them commands that there are; no change of the bit rate, after which it is silent for a while.
    if (i % 4 != 0)
      noise.data[0] = std::array<std::uint8_t, 8>{4, 0x11, 0x17, 0x40, 0x43, 0x4C, 0x51, 0x5E}[random() % 8];
    if (noise.data[0] == 0x15) continue;
    port->send(noise);
    CanFrame answer;
    while (port->receive(answer)) {
      EXPECT_EQ(answer.size, answer.id == LssSlave::kSlaveId ? 8 : answer.size);
    }
  }
  EXPECT_TRUE(node.powered());
}

}  // namespace
}  // namespace rmac::vdrive::test
