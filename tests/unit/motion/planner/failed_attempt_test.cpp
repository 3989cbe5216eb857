#include "planner/failed_attempt.hpp"

#include <gtest/gtest.h>

namespace rmac {
namespace {

TEST(FailedAttempt, IsRepeatedAfterTenCycles) {
  FailedAttempt attempt;
  EXPECT_FALSE(attempt.too_early(0, false)) << "nothing failed yet";
  attempt.failed(100, 7, false);
  EXPECT_TRUE(attempt.too_early(100, false));
  EXPECT_TRUE(attempt.too_early(109, false));
  EXPECT_FALSE(attempt.too_early(110, false));
}

TEST(FailedAttempt, InMotionIsNoReasonToWaitAtRest) {
  FailedAttempt attempt;
  attempt.failed(100, 7, false);
  EXPECT_FALSE(attempt.too_early(101, true));
  attempt.failed(102, 7, true);
  EXPECT_TRUE(attempt.too_early(103, true));
  EXPECT_FALSE(attempt.too_early(103, false));
}

TEST(FailedAttempt, OfAnotherWishIsForgotten) {
  FailedAttempt attempt;
  attempt.failed(100, 7, false);
  attempt.forget();
  EXPECT_FALSE(attempt.too_early(101, false));
}

TEST(FailedAttempt, KnowsWhichPlanItWasToFollow) {
  FailedAttempt attempt;
  attempt.failed(100, 7, false);
  EXPECT_TRUE(attempt.was_behind(7));
  EXPECT_FALSE(attempt.was_behind(8));
}

}  // namespace
}  // namespace rmac
