#include "gateway/rmac/terminal/table.hpp"

#include <gtest/gtest.h>

namespace rmac::cli {
namespace {

TEST(Table, PutsNumbersToTheRightAndWordsToTheLeft) {
  EXPECT_EQ(table({"name", "mm"}, {{"a", "7"}, {"bcdef", "-12.5"}}),
            "name      mm\n"
            "a          7\n"
            "bcdef  -12.5\n");
}

TEST(Table, LeavesAHeadingOutThatSaysNothing) {
  EXPECT_EQ(table({"", ""}, {{"feed", "10"}}), "feed  10\n");
}

TEST(Table, CountsACharacterOfSeveralBytesOnce) {
  EXPECT_EQ(table({"", ""}, {{"N·m", "x"}, {"abc", "y"}}), "N·m  x\nabc  y\n");
}

TEST(Table, KeepsWhateverACellHoldsWithinItsLine) {
  EXPECT_EQ(table({""}, {{"a\nb\x1b"}}), "a?b?\n");
}

TEST(Number, HasNoTrailingZerosAndNoNegativeNothing) {
  EXPECT_EQ(number(1.5), "1.5");
  EXPECT_EQ(number(2), "2");
  EXPECT_EQ(number(0.12345), "0.123");
  EXPECT_EQ(number(-0.0001), "0");
  EXPECT_EQ(number(1200, 0), "1200");
}

}  // namespace
}  // namespace rmac::cli
