#include "rmac/fieldbus/canopen/lss.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "unit/fieldbus/canopen/lss/lss_peer.hpp"

// CiA 305: the master against slaves that take liberties.
namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::LssPeer;
using test::LssWire;
using Key = std::array<std::uint32_t, 4>;

Key key(const Identity& identity) {
  return {identity.vendor_id, identity.product_code, identity.revision_number, identity.serial_number};
}
std::multiset<Key> keys(const std::vector<Identity>& identities) {
  std::multiset<Key> keys;
  for (const Identity& identity : identities) keys.insert(key(identity));
  return keys;
}

TEST(LssOfSmallStacks, FindsTheOneThatAnswersEverythingOnceItConfigures) {
  LssWire wire;
  const LssPeer& peer = wire.add({0x1A3, 0x402, 0x10002, 0x1234567});
  const auto found = lss_scan(wire);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(key(found->front()), (Key{0x1A3, 0x402, 0x10002, 0x1234567}));
  EXPECT_FALSE(peer.configures());
  EXPECT_LT(wire.now(), seconds(15));
  EXPECT_LT(wire.now(), seconds(15));
}

TEST(LssOfSmallStacks, FindsSeveralWhateverPartsOfTheirIdentitiesAreEqual) {
  std::mt19937 random(305);  // NOLINT(cert-msc51-cpp): the same numbers every time
  for (int round = 0; round < 6; ++round) {
    LssWire wire;
    std::multiset<Key> there;
    const std::size_t count = 2 + random() % 4;
    while (there.size() < count) {
      constexpr std::array<std::uint32_t, 5> kSerials{0, 0xFFFFFFFF, 1, 0x80000000, 0x55AA55AA};
      const Key one{static_cast<std::uint32_t>(random() % 2) * 0x80000001, static_cast<std::uint32_t>(random() % 2),
                    static_cast<std::uint32_t>(random() % 2) << 16, kSerials.at(random() % kSerials.size())};
      if (there.contains(one)) continue;
      there.insert(one);
      wire.add(one, {.answers_after = milliseconds(random() % 30)});
    }
    const auto found = lss_scan(wire);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(keys(*found), there) << "round " << round;
  }
}

TEST(LssOfSmallStacks, GivesTheOnlyOneItsId) {
  for (const bool knows_inquiry : {true, false}) {
    LssWire wire;
    const LssPeer& peer = wire.add({0x1A3, 0x402, 1, 0}, {.knows_inquiry = knows_inquiry});
    const auto given = lss_assign(wire, 9, {});
    ASSERT_TRUE(given) << given.error().message;
    EXPECT_EQ(peer.node(), 9);
    EXPECT_EQ(peer.stored(), 1);
    EXPECT_TRUE(given->stored);
    EXPECT_EQ(key(given->identity), (Key{0x1A3, 0x402, 1, 0}));
  }
}

TEST(LssOfSmallStacks, SaysThatTheOneWithItsNewIdDoesNotComeUp) {
  LssWire wire;
  wire.add({0x1A3, 0x402, 1, 7}, {.boots = false});
  const auto given = lss_assign(wire, 9, {});
  ASSERT_FALSE(given);
  EXPECT_EQ(given.error().message.substr(0, given.error().message.find(" within")),
            "the node took the id 9 and did not come up with it");
}

TEST(LssOfSmallStacks, GivesOneOfSeveralAnIdByItsIdentityAndTheLastOneWithout) {
  LssWire wire;
  LssPeer& first = wire.add({0x1A3, 0x402, 1, 0});
  LssPeer& second = wire.add({0x1A3, 0x402, 1, 0xFFFFFFFF});
  const auto refused = lss_assign(wire, 9, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("several nodes without an id"), std::string::npos) << refused.error().message;
  EXPECT_FALSE(first.configures() || second.configures());
  const auto named = lss_assign(wire, 9, Identity{0x1A3, 0x402, 1, 0xFFFFFFFF});
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(second.node(), 9);
  EXPECT_EQ(first.node(), LssPeer::kUnconfigured);
  const auto last = lss_assign(wire, 10, {});
  ASSERT_TRUE(last) << last.error().message;
  EXPECT_EQ(first.node(), 10);
}

TEST(LssOfSmallStacks, TakesBackOneThatAKilledScanLeftConfiguring) {
  LssWire wire;
  LssPeer& peer = wire.add({1, 2, 3, 4});
  LssPeer& left = wire.add({1, 2, 3, 5});
  left.leave_configuring();
  const auto found = lss_scan(wire);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(keys(*found), (std::multiset<Key>{{1, 2, 3, 4}, {1, 2, 3, 5}}));
  EXPECT_FALSE(peer.configures() || left.configures());
}

// Red when one lost frame makes a node one that does not listen.
TEST(LssOfSmallStacks, TakesBackOneThatDidNotHearItAtFirst) {
  LssWire wire;
  wire.add({1, 2, 3, 4});
  wire.add({1, 2, 3, 5}).leave_configuring();
  int switches = 0;
  wire.listen = [&](const CanFrame& frame) { wire.cut = frame.data[0] == 0x04 && ++switches == 1; };
  const auto found = lss_scan(wire);
  wire.listen = nullptr;
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(keys(*found), (std::multiset<Key>{{1, 2, 3, 4}, {1, 2, 3, 5}}));
}

TEST(LssOfSmallStacks, SaysThatOneDoesNotListenInsteadOfSearchingForEver) {
  LssWire wire;
  wire.add({1, 2, 3, 4});
  wire.add({1, 2, 3, 5}, {.ignores_switches = true}).leave_configuring();
  const auto refused = lss_scan(wire);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("answers every step of a fast scan"), std::string::npos)
      << refused.error().message;
  EXPECT_LT(wire.now(), seconds(10));
}

TEST(LssOfSmallStacks, WaitsAsLongAsTheSlowestAnswers) {
  LssWire wire;
  wire.add({1, 2, 3, 4});
  const LssPeer& slow = wire.add({1, 2, 3, 5}, {.answers_after = milliseconds(170), .stores_for = milliseconds(700)});
  const auto found = lss_scan(wire);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(keys(*found), (std::multiset<Key>{{1, 2, 3, 4}, {1, 2, 3, 5}}));
  const auto given = lss_assign(wire, 7, Identity{1, 2, 3, 5});
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_TRUE(given->stored) << "its memory is slow";
  EXPECT_EQ(slow.node(), 7);
}

TEST(LssOfSmallStacks, ANodeWithAnIdThatAnswersTheBeginningIsNoneWithout) {
  LssWire wire;
  wire.add({1, 2, 3, 4}, {.always_answers_begin = true}, 12);
  const auto nobody = lss_scan(wire);
  ASSERT_TRUE(nobody) << nobody.error().message;
  EXPECT_TRUE(nobody->empty());
  wire.add({1, 2, 3, 5});
  const auto found = lss_scan(wire);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(keys(*found), (std::multiset<Key>{{1, 2, 3, 5}}));
}

TEST(LssOfSmallStacks, TwoOfOneIdentityAreTwoAndGetNoIdTogether) {
  LssWire wire;
  const LssPeer& first = wire.add({1, 2, 3, 0});
  const LssPeer& second = wire.add({1, 2, 3, 0});
  const auto found = lss_scan(wire);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(keys(*found), (std::multiset<Key>{{1, 2, 3, 0}, {1, 2, 3, 0}}));
  for (const std::optional<Identity>& named : {std::optional<Identity>(), std::optional(Identity{1, 2, 3, 0})}) {
    const auto refused = lss_assign(wire, 9, named);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("connect them one after the other"), std::string::npos)
        << refused.error().message;
    EXPECT_EQ(first.node(), LssPeer::kUnconfigured);
    EXPECT_EQ(second.node(), LssPeer::kUnconfigured);
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
