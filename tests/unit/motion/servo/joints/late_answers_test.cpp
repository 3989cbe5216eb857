#include "servo/joints/late_answers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace rmac::servo_test {
namespace {

constexpr std::array<std::uint8_t, 2> kNew{0, 0};
constexpr std::array<std::uint8_t, 3> kOld{0, 2, 1};
constexpr std::array<std::uint8_t, 1> kByOne{1};

std::vector<std::uint64_t> told(LateAnswers late, const std::vector<std::uint64_t>& missed) {
  std::vector<std::uint64_t> seen;
  for (const std::uint64_t cycles : missed) {
    late.step(cycles);
    seen.push_back(late.now());
  }
  return seen;
}

TEST(LateAnswers, TellOfALateCycleInThatCycleWhereTheyAreNew) {
  EXPECT_EQ(told(LateAnswers(kNew), {0, 2, 0, 0}), (std::vector<std::uint64_t>{0, 2, 0, 0}));
}

TEST(LateAnswers, TellOfItAsManyCyclesLaterAsTheOldestIsOld) {
  EXPECT_EQ(told(LateAnswers(kOld), {0, 1, 0, 0, 0}), (std::vector<std::uint64_t>{0, 1, 1, 1, 0}));
  EXPECT_EQ(told(LateAnswers(kByOne), {3, 1, 0, 0}), (std::vector<std::uint64_t>{3, 3, 3, 0}));
}

}  // namespace
}  // namespace rmac::servo_test
