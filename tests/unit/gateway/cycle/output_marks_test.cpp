#include "gateway/cycle/output_marks.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

class MarksOfOutputs : public testing::Test {
 protected:
  [[nodiscard]] std::uint64_t cycle(std::uint64_t moves_done) {
    const ServoWishes& wished = servo_.read();
    return path_.step(wished.outputs, wished.marks_settled, moves_done);
  }
  void settle() { marks_.settle(path_.passed()); }

  LatestValue<ServoWishes> servo_;
  MarkRing ring_;
  PathOutputs path_{ring_};
  StandingWishes wishes_{servo_};
  OutputMarks marks_{wishes_, ring_};
};

TEST_F(MarksOfOutputs, BecomeWishesOnceTheyArePassed) {
  marks_.add(1, {.mask = 0b11, .values = 0b01});
  marks_.add(2, {.mask = 0b100, .values = 0b100});
  EXPECT_EQ(cycle(1), 0b1U);
  EXPECT_EQ(wishes_.now().outputs, 0U) << "nobody told yet";
  settle();
  EXPECT_EQ(wishes_.now().outputs, 0b1U);
  EXPECT_EQ(wishes_.now().marks_settled, 1U);
  EXPECT_EQ(cycle(1), 0b1U);
  EXPECT_EQ(cycle(2), 0b101U);
  settle();
  EXPECT_EQ(wishes_.now().outputs, 0b101U);
}

TEST_F(MarksOfOutputs, AreUndoneByWhatIsWishedAfterwards) {
  marks_.add(1, {.mask = 1, .values = 1});
  EXPECT_EQ(cycle(1), 1U);
  settle();
  wishes_.change([](ServoWishes& wishes) { wishes.outputs = 0; });
  EXPECT_EQ(cycle(1), 0U);
  EXPECT_EQ(cycle(5), 0U);
}

TEST_F(MarksOfOutputs, AreDroppedBeforeTheyArePassed) {
  marks_.add(1, {.mask = 1, .values = 1});
  EXPECT_EQ(cycle(0), 0U);
  marks_.drop();
  EXPECT_EQ(cycle(9), 0U);
  EXPECT_EQ(path_.passed(), 0U);
  marks_.add(9, {.mask = 2, .values = 2});
  EXPECT_EQ(cycle(9), 2U) << "others come after them";
  settle();
  EXPECT_EQ(wishes_.now().outputs, 2U);
}

// Red when marks beyond the ring's room are lost.
TEST_F(MarksOfOutputs, AreAsManyAsAreQueued) {
  constexpr std::uint64_t kMany = 5000;
  for (std::uint64_t i = 1; i <= kMany; ++i) marks_.add(i, {.mask = 1, .values = i % 2});
  for (std::uint64_t i = 1; i <= kMany; ++i) {
    ASSERT_EQ(cycle(i), i % 2) << i;
    if (i % 100 == 0) settle();
  }
  settle();
  EXPECT_EQ(wishes_.now().marks_settled, kMany);
}

}  // namespace
}  // namespace rmac::gateway
