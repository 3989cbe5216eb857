#include "gateway/servo/path_outputs.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <vector>

namespace rmac::gateway {
namespace {

class OutputsOnThePath : public testing::Test {
 protected:
  void mark(std::uint64_t after_moves, std::uint64_t mask, std::uint64_t values) {
    ASSERT_TRUE(ring_.push({++number_, after_moves, mask, values}));
  }
  MarkRing ring_;
  PathOutputs outputs_{ring_};
  std::uint64_t number_ = 0;
};

TEST_F(OutputsOnThePath, AreAsTheyAreWishedWithoutMarks) {
  EXPECT_EQ(outputs_.step(0b101, 0, 0), 0b101U);
  EXPECT_EQ(outputs_.step(0b010, 0, 7), 0b010U);
  EXPECT_EQ(outputs_.passed(), 0U);
}

TEST_F(OutputsOnThePath, SwitchInTheCycleInWhichTheMoveBeforeIsDone) {
  mark(3, 0b11, 0b01);
  EXPECT_EQ(outputs_.step(0b110, 0, 2), 0b110U);
  EXPECT_EQ(outputs_.passed(), 0U);
  EXPECT_EQ(outputs_.step(0b110, 0, 3), 0b101U) << "on, off, and the third as it is wished";
  EXPECT_EQ(outputs_.passed(), 1U);
  EXPECT_EQ(outputs_.step(0b110, 0, 3), 0b101U) << "until the wishes know";
  EXPECT_EQ(outputs_.step(0b101, 1, 3), 0b101U);
  EXPECT_EQ(outputs_.step(0b100, 1, 4), 0b100U) << "then they alone count";
}

TEST_F(OutputsOnThePath, SwitchAllThatOnePassesAtOnceInTheirOrder) {
  mark(1, 0b1, 0b1);
  mark(2, 0b11, 0b10);
  mark(2, 0b1, 0b1);
  mark(5, 0b100, 0b100);
  EXPECT_EQ(outputs_.step(0, 0, 4), 0b11U) << "many short moves may end in one cycle";
  EXPECT_EQ(outputs_.passed(), 3U);
  EXPECT_EQ(outputs_.step(0, 2, 4), 0b1U) << "the last one is not settled yet";
}

TEST_F(OutputsOnThePath, AreNotSwitchedByMarksThatWereDropped) {
  mark(1, 0b1, 0b1);
  mark(2, 0b1, 0b1);
  EXPECT_EQ(outputs_.step(0, 0, 0), 0U);
  mark(1, 0b10, 0b10);
  EXPECT_EQ(outputs_.step(0, 2, 1), 0b10U) << "what is queued afterwards is not held up by them";
  EXPECT_EQ(outputs_.passed(), 3U);
}

// Red when a mark is lost, or comes twice, or an older one undoes a later one, however late they are settled.
TEST_F(OutputsOnThePath, AreThoseOfAllMarksInTheirOrderWheneverTheyAreSettled) {
  std::mt19937 random(3);  // NOLINT(cert-msc51-cpp): the same marks every time
  const auto upto = [&](std::uint64_t most) { return std::uniform_int_distribution<std::uint64_t>(0, most)(random); };
  std::deque<OutputMark> ahead;    // not passed, by the rule
  std::vector<OutputMark> passed;  // not settled
  std::uint64_t wished = 0, settled = 0, moves = 0, place = 0, expected = 0;
  for (int cycle = 0; cycle < 20000; ++cycle) {
    for (std::uint64_t n = upto(3); n > 0 && ring_.size() < 200; --n) {
      place += upto(3);
      const OutputMark made{++number_, std::max(place, moves), upto(15), upto(15)};
      ahead.push_back(made);
      ASSERT_TRUE(ring_.push(made));
    }
    moves += upto(4);
    while (!ahead.empty() && ahead.front().after_moves <= moves) {
      expected = (expected & ~ahead.front().mask) | (ahead.front().values & ahead.front().mask);
      passed.push_back(ahead.front());
      ahead.pop_front();
    }
    ASSERT_EQ(outputs_.step(wished, settled, moves), expected) << "cycle " << cycle;
    // Whoever settles comes every so often, and now and then late.
    if (upto(cycle % 1000 < 100 ? 200 : 3) != 0) continue;
    for (const OutputMark& mark : passed) wished = (wished & ~mark.mask) | (mark.values & mark.mask);
    if (!passed.empty()) settled = passed.back().number;
    passed.clear();
    ASSERT_EQ(wished, expected);
  }
}

}  // namespace
}  // namespace rmac::gateway
