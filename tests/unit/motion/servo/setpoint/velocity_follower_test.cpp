#include "servo/setpoint/velocity_follower.hpp"

#include <gtest/gtest.h>

#include "unit/motion/servo/period.hpp"

namespace rmac {
namespace {

using servo_test::kPeriod;

/// A joint that may be 0.5 mm behind its setpoint, and travels from -10 to 10 mm.
class VelocityFollowing : public testing::Test {
 protected:
  ServoJoint joint_ = [] {
    ServoJoint made;
    made.max_following_error = 1;
    made.bounds.stop_deceleration = 1000;
    made.bounds.min_position = -10;
    made.bounds.max_position = 10;
    return made;
  }();
  VelocityFollower follower_{joint_, kPeriod};
};

TEST_F(VelocityFollowing, IsOnThePlanAsLongAsNothingKeepsIt) {
  follower_.begin(1, 1);
  const JointSetpoint wanted = follower_.step({1.1, 20, 300}, 1.0, 0.9);
  EXPECT_EQ(wanted.position, 1.1);
  EXPECT_EQ(wanted.velocity, 20);
  EXPECT_EQ(wanted.acceleration, 300);
  EXPECT_EQ(follower_.slip(), 0);
}

TEST_F(VelocityFollowing, KeepsTheDistanceToThePlanThatItBeganWith) {
  follower_.begin(4, 1);
  EXPECT_EQ(follower_.slip(), 3);
  EXPECT_EQ(follower_.step({1.1, 20, 0}, 4.0, 4.0).position, 4.1);
  EXPECT_EQ(follower_.slip(), 3);
  follower_.on_plan();
  EXPECT_EQ(follower_.slip(), 0);
}

TEST_F(VelocityFollowing, GoesNoFurtherAheadThanHalfOfTheFollowingError) {
  follower_.begin(2, 2);
  const JointSetpoint wanted = follower_.step({2.02, 20, 300}, 2.0, 1.0);
  EXPECT_NEAR(wanted.position, 1.52, 1e-12) << "from where it may be, with the plan's velocity";
  EXPECT_EQ(wanted.velocity, 20);
  EXPECT_EQ(wanted.acceleration, 300);
  EXPECT_NEAR(follower_.slip(), -0.5, 1e-12);
  const JointSetpoint back = follower_.step({2.0, -20, 0}, -1.0, 1.0);
  EXPECT_NEAR(back.position, 0.48, 1e-12);
}

TEST_F(VelocityFollowing, BrakesTowardsTheEndsOfItsTravel) {
  follower_.begin(9.9, 0);
  const JointSetpoint wanted = follower_.step({0, 500, 300}, 9.9, 9.9);
  // v T + v² / 2a = way
  EXPECT_NEAR(wanted.velocity * kPeriod + wanted.velocity * wanted.velocity / 2000, 0.1, 1e-9);
  EXPECT_EQ(wanted.acceleration, 0);
  EXPECT_NEAR(wanted.position, 9.9 + wanted.velocity * kPeriod, 1e-12);

  follower_.begin(-9.9, 0);
  EXPECT_NEAR(follower_.step({0, -500, 0}, -9.9, -9.9).velocity, -wanted.velocity, 1e-9);
  EXPECT_EQ(follower_.step({0, 150, 0}, -9.9, -9.9).velocity, 150) << "away from an end it is free";
}

TEST_F(VelocityFollowing, StandsBeyondItsTravel) {
  follower_.begin(10.5, 0);
  EXPECT_EQ(follower_.step({0, 30, 0}, 10.5, 10.5).velocity, 0);
  EXPECT_EQ(follower_.step({0, -30, 0}, 10.5, 10.5).velocity, -30);
}

TEST_F(VelocityFollowing, WithoutADecelerationStopsInTheLastCycle) {
  joint_.bounds.stop_deceleration = 0;
  follower_.begin(9.9, 0);
  EXPECT_NEAR(follower_.step({0, 500, 0}, 9.9, 9.9).velocity, 0.1 / kPeriod, 1e-9);
}

}  // namespace
}  // namespace rmac
