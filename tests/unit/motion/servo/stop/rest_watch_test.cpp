#include "servo/stop/rest_watch.hpp"

#include <gtest/gtest.h>

#include "unit/motion/servo/period.hpp"

namespace rmac {
namespace {

using servo_test::kPeriod;
constexpr double kTurn = 10000;  // 5 counts are still

/// A drive with an encoder, and one that only tells its speed.
class AtRest : public testing::Test {
 protected:
  AtRest() { rest_.begin(); }
  void cycle(std::int64_t counts, double rpm) {
    rest_.begin_cycle();
    rest_.look_at_counts(0, counts, kTurn);
    rest_.look_at_speed(1, rpm);
  }
  RestWatch rest_{2, kPeriod};
};

TEST_F(AtRest, DriveStandsAfterTwentyMillisecondsWithinAFewCounts) {
  for (int i = 0; i < 20; ++i) {
    cycle(7000 + i % 6, 100);
    EXPECT_FALSE(rest_.reached(0)) << i;
  }
  cycle(7000, 100);
  EXPECT_TRUE(rest_.reached(0));
  EXPECT_FALSE(rest_.reached(1));
  EXPECT_FALSE(rest_.all_reached());
}

TEST_F(AtRest, MotionBeginsTheTimeAnew) {
  for (int i = 0; i < 15; ++i) cycle(7000, 0);
  for (int i = 0; i < 20; ++i) {
    cycle(7006, 0);
    EXPECT_FALSE(rest_.reached(0)) << i;
  }
  cycle(7006, 0);
  EXPECT_TRUE(rest_.all_reached());
}

TEST_F(AtRest, CreepingDriveDoesNotStand) {
  for (int i = 0; i < 200; ++i) cycle(i, 0);
  EXPECT_FALSE(rest_.reached(0));
}

TEST_F(AtRest, CoarseEncoderMayMoveByTwoCounts) {
  for (int i = 0; i <= 20; ++i) {
    rest_.begin_cycle();
    rest_.look_at_counts(0, i % 3, 100);
    rest_.look_at_counts(1, i % 4, 100);
  }
  EXPECT_TRUE(rest_.reached(0));
  EXPECT_FALSE(rest_.reached(1));
}

TEST_F(AtRest, SteadySpeedIsNoRestAndOneRpmIs) {
  for (int i = 0; i <= 30; ++i) cycle(0, i < 5 ? -500 : -1);
  EXPECT_TRUE(rest_.reached(1));
  rest_.begin();
  for (int i = 0; i <= 30; ++i) cycle(0, 1.1);
  EXPECT_FALSE(rest_.reached(1));
}

TEST_F(AtRest, SpeedMustHaveBeenRestForTheWholeTime) {
  for (int i = 0; i < 20; ++i) cycle(0, 0);
  EXPECT_FALSE(rest_.reached(1));
  cycle(0, 5);
  for (int i = 0; i < 20; ++i) cycle(0, 0);
  EXPECT_FALSE(rest_.reached(1));
  cycle(0, 0);
  EXPECT_TRUE(rest_.reached(1));
}

TEST_F(AtRest, StaysReachedAndBeginsAnewWithTheNextStop) {
  for (int i = 0; i <= 20; ++i) cycle(0, 0);
  cycle(9000, 900);
  EXPECT_TRUE(rest_.all_reached());
  rest_.begin();
  EXPECT_FALSE(rest_.reached(0));
  EXPECT_FALSE(rest_.reached(1));
}

TEST_F(AtRest, DriveThatDoesNotBrakeIsGivenUpAfterTenSeconds) {
  for (int i = 0; i < 10000; ++i) cycle(i * 100, 500);
  EXPECT_FALSE(rest_.reached(0));
  cycle(0, 500);
  EXPECT_TRUE(rest_.all_reached());
}

}  // namespace
}  // namespace rmac
