#include "gateway/cycle/states/spindle_wait.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

TEST(SpindleWait, IsTooLongOnceMotionHasWaitedForMoreThanItsTime) {
  SpindleWait wait;
  EXPECT_FALSE(wait.too_long(0)) << "nobody was told another speed";
  wait.begin(2);
  EXPECT_TRUE(wait.waiting());
  EXPECT_FALSE(wait.too_long(10)) << "its time begins when motion waits";
  EXPECT_FALSE(wait.too_long(12));
  EXPECT_TRUE(wait.too_long(12.01));
  EXPECT_FALSE(wait.waiting()) << "told once";
}

TEST(SpindleWait, BeginsAnewWithTheNextStart) {
  SpindleWait wait;
  wait.begin(2);
  EXPECT_FALSE(wait.too_long(0));
  wait.restart();
  EXPECT_TRUE(wait.waiting());
  EXPECT_FALSE(wait.too_long(5));
  EXPECT_TRUE(wait.too_long(7.01));
}

TEST(SpindleWait, EndsAtSpeed) {
  SpindleWait wait;
  wait.begin(2);
  EXPECT_FALSE(wait.too_long(0));
  wait.end();
  EXPECT_FALSE(wait.waiting());
  EXPECT_FALSE(wait.too_long(100));
}

}  // namespace
}  // namespace rmac::gateway
