#include "gateway/simulators/vdrive/axis/target_watch.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

TEST(TargetWatch, IsAtTheTargetAfterTheWindowTime) {
  TargetWatch watch;
  watch.reach(true, 0.025, 0.01);
  watch.reach(true, 0.025, 0.01);
  EXPECT_FALSE(watch.at_target());
  watch.reach(true, 0.025, 0.01);
  EXPECT_TRUE(watch.at_target());
  watch.reach(false, 0.025, 0.01);
  EXPECT_FALSE(watch.at_target());
  watch.reach(true, 0.025, 0.01);
  EXPECT_FALSE(watch.at_target()) << "the time begins anew";
}

TEST(TargetWatch, LeavesATargetForAnother) {
  TargetWatch watch;
  watch.reach(true, 0, 0.01);
  watch.leave_target();
  EXPECT_FALSE(watch.at_target());
}

TEST(TargetWatch, ShowsAFollowingErrorAtOnceAndTripsAfterItsTime) {
  TargetWatch watch;
  EXPECT_FALSE(watch.follow(true, 0.015, 0.01));
  EXPECT_TRUE(watch.following_error());
  EXPECT_TRUE(watch.follow(true, 0.015, 0.01));
  EXPECT_FALSE(watch.follow(false, 0.015, 0.01));
  EXPECT_FALSE(watch.following_error());
  EXPECT_FALSE(watch.follow(true, 0.015, 0.01)) << "the time begins anew";
}

}  // namespace
}  // namespace rmac::vdrive
