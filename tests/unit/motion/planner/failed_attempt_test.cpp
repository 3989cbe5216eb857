#include "planner/failed_attempt.hpp"

#include <gtest/gtest.h>

namespace rmac {
namespace {

constexpr bool kInMotion = false, kFromRest = true;

TEST(FailedAttempt, HoldsNothingBackWhereNoneFailed) {
  const FailedAttempt attempt;
  EXPECT_FALSE(attempt.too_early(0, kInMotion));
  EXPECT_FALSE(attempt.too_early(0, kFromRest));
}

TEST(FailedAttempt, IsRepeatedAfterTenCyclesAndNoSooner) {
  FailedAttempt attempt;
  attempt.record(100, 7, kInMotion);
  EXPECT_TRUE(attempt.too_early(100, kInMotion));
  EXPECT_TRUE(attempt.too_early(109, kInMotion));
  EXPECT_FALSE(attempt.too_early(110, kInMotion));
}

TEST(FailedAttempt, IsRepeatedSoonerWhereItIsUrgent) {
  FailedAttempt attempt;
  attempt.record(100, 7, kInMotion, 2);
  EXPECT_TRUE(attempt.too_early(101, kInMotion));
  EXPECT_FALSE(attempt.too_early(102, kInMotion));
}

TEST(FailedAttempt, HoldsBackForTenCyclesFromTheLastOne) {
  FailedAttempt attempt;
  attempt.record(100, 7, kFromRest);
  attempt.record(110, 7, kFromRest);
  EXPECT_TRUE(attempt.too_early(119, kFromRest));
  EXPECT_FALSE(attempt.too_early(120, kFromRest));
}

TEST(FailedAttempt, InMotionHoldsNothingBackAtRestNorTheOtherWayRound) {
  FailedAttempt attempt;
  attempt.record(100, 7, kInMotion);
  EXPECT_FALSE(attempt.too_early(101, kFromRest));
  attempt.record(102, 7, kFromRest);
  EXPECT_TRUE(attempt.too_early(103, kFromRest));
  EXPECT_FALSE(attempt.too_early(103, kInMotion));
}

TEST(FailedAttempt, HoldsNothingBackOnceForgotten) {
  FailedAttempt attempt;
  attempt.record(3, 7, kInMotion);
  attempt.forget();
  EXPECT_FALSE(attempt.too_early(4, kInMotion));
}

TEST(FailedAttempt, KnowsThePlanItWasBasedOnEvenOnceForgotten) {
  FailedAttempt attempt;
  attempt.record(100, 7, kInMotion);
  attempt.forget();
  EXPECT_TRUE(attempt.was_based_on(7));
  EXPECT_FALSE(attempt.was_based_on(8));
}

}  // namespace
}  // namespace rmac
