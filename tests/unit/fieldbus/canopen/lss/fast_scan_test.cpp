// What a fast scan asks, and how long it waits (CiA 305, 3.9).
#include <gtest/gtest.h>

#include "rmac/fieldbus/canopen/lss.hpp"
#include "unit/fieldbus/canopen/lss/lss_peer.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using test::LssWire;

constexpr std::uint8_t kFastScan = 0x51, kBegin = 0x80;

struct Asked {
  nanoseconds at;
  CanFrame frame;
};

std::vector<Asked> questions_of_scan(LssWire& wire, std::size_t found) {
  std::vector<Asked> asked;
  wire.listen = [&](const CanFrame& frame) {
    if (frame.data[0] == kFastScan) asked.push_back({wire.now(), frame});
  };
  const auto nodes = lss_scan(wire);
  wire.listen = nullptr;
  EXPECT_TRUE(nodes) << nodes.error().message;
  EXPECT_EQ(nodes->size(), found);
  return asked;
}

// Red when a slave that does as the standard says would be told to configure, or to look for what there is not.
TEST(FastScan, AsksNothingThatHasASlaveConfigure) {
  LssWire wire;
  wire.add({0x12345678, 0, 0xFFFFFFFF, 0x80000001});
  wire.add({0x12345678, 0, 0xFFFFFFFF, 0x00000001});
  const auto asked = questions_of_scan(wire, 2);
  ASSERT_FALSE(asked.empty());
  EXPECT_EQ(asked.front().frame, (CanFrame{.id = 0x7E5, .size = 8, .data = {kFastScan, 0, 0, 0, 0, kBegin, 0, 0}}));
  for (const Asked& one : asked) {
    const std::uint8_t bit = one.frame.data[5], part = one.frame.data[6], next = one.frame.data[7];
    ASSERT_EQ(one.frame.id, 0x7E5);
    ASSERT_EQ(one.frame.size, 8);
    ASSERT_TRUE(bit < 32 || bit == kBegin) << int{bit};
    ASSERT_TRUE(bit != kBegin || (part == 0 && next == 0));
    ASSERT_LE(part, 3);
    ASSERT_TRUE(next == part || (bit == 0 && next == part + 1 && next <= 3)) << int{part} << " " << int{next};
  }
}

TEST(FastScan, AsksForEachBitTwiceAtMost) {
  for (const test::LssPeer::Identity& identity :
       {test::LssPeer::Identity{0, 0, 0, 0}, {0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}, {1, 0x80000000, 2, 3}}) {
    LssWire wire;
    wire.add(identity);
    // Two for who does not listen, and the beginning once more; a step of each part leads to the next.
    EXPECT_LE(questions_of_scan(wire, 1).size(), 2U * 128 + 4 + 3);
  }
}

TEST(FastScan, WaitsTwiceAsLongAsTheSlowestTookToTheFirstQuestion) {
  for (const auto& [takes_ms, waits_ms] : {std::pair{2, 50}, {24, 50}, {30, 60}, {80, 160}}) {
    LssWire wire;
    wire.add({1, 2, 3, 4}, {.answers_after = milliseconds(takes_ms)});
    wire.add({1, 2, 3, 5}, {.answers_after = milliseconds(1)});
    const auto asked = questions_of_scan(wire, 2);
    ASSERT_GT(asked.size(), 3U);
    EXPECT_EQ(asked[1].at - asked[0].at, milliseconds(500)) << "for the slowest that there may be";
    for (std::size_t i = 2; i < asked.size(); ++i) {
      ASSERT_EQ(asked[i].at - asked[i - 1].at, milliseconds(waits_ms)) << i;
    }
  }
}

/// Cuts the wire for those questions of a fast scan that `lost` names by their number, from 1.
void lose(LssWire& wire, int& asked, const std::function<bool(int number)>& lost) {
  wire.listen = [&wire, &asked, lost](const CanFrame& frame) {
    if (frame.data[0] == kFastScan) wire.cut = lost(++asked);
  };
}

TEST(FastScan, FindsNobodyWhoLeavesAfterTheFirstQuestion) {
  LssWire wire;
  wire.add({1, 2, 3, 4});
  int asked = 0;
  lose(wire, asked, [](int number) { return number > 1; });
  const auto nodes = lss_scan(wire);
  ASSERT_TRUE(nodes) << nodes.error().message;
  EXPECT_TRUE(nodes->empty());
  EXPECT_EQ(asked, 2 + 3) << "three searches, of which each begins anew";
}

TEST(FastScan, SearchesAgainMorePatientlyWhereAnAnswerIsMissing) {
  for (const int lost : {3, 4, 50, 200}) {
    LssWire wire;
    wire.add({1, 2, 3, 4});
    int asked = 0;
    lose(wire, asked, [lost](int number) { return number == lost; });
    const auto nodes = lss_scan(wire);
    ASSERT_TRUE(nodes) << nodes.error().message;
    EXPECT_EQ(nodes->size(), 1U) << lost;
  }
}

// Red when a node that is heard at times is told as another one, or when the search does not end.
TEST(FastScan, GivesUpAfterThreeSearchesWhereAnswersAreMissingAtTimes) {
  LssWire wire;
  wire.add({1, 2, 3, 0x80000000});
  int searches = 0, asked = 0;
  wire.listen = [&](const CanFrame& frame) {
    const bool begins = frame.data[0] == kFastScan && frame.data[5] == kBegin;
    searches += begins ? 1 : 0;
    asked = begins ? 0 : asked + 1;
    wire.cut = asked > 20;  // the first bits of its identity fit, and nothing behind them
  };
  const auto nodes = lss_scan(wire);
  ASSERT_FALSE(nodes);
  EXPECT_NE(nodes.error().message.find("answer at times and not at others, within 200 ms too"), std::string::npos)
      << nodes.error().message;
  EXPECT_EQ(searches, 1 + 3);
}

// Red when any of the five steps that lead to a node may fail: it does not configure then.
TEST(FastScan, GivesNoIdToANodeThatLeavesOnceItIsFound) {
  for (int steps = 0; steps < 5; ++steps) {
    LssWire wire;
    const test::LssPeer& peer = wire.add({1, 2, 3, 4});
    const auto asked_for_it = static_cast<int>(questions_of_scan(wire, 1).size());
    int asked = 0;
    lose(wire, asked, [=](int number) { return number > asked_for_it + steps; });
    const auto given = lss_assign(wire, 9, {});
    ASSERT_FALSE(given);
    EXPECT_EQ(given.error().message,
              "vendor 1h, product 2h, revision 3h, serial 4h was found and does not answer any more; is it still "
              "connected?");
    EXPECT_EQ(peer.node(), test::LssPeer::kUnconfigured);
  }
}

TEST(FastScan, EndsWithItsFirstQuestionWhereNobodyAnswers) {
  LssWire wire;
  wire.add({1, 2, 3, 4}, {}, 12);
  EXPECT_EQ(questions_of_scan(wire, 0).size(), 1U);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
