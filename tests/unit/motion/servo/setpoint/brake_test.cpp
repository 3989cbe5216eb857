#include "servo/setpoint/brake.hpp"

#include <gtest/gtest.h>

namespace rmac {
namespace {

constexpr double kPeriod = 0.01;

TEST(Brake, TakesAllJointsToRestInStepAsFastAsTheSlowestMay) {
  Brake brake;
  brake.begin(std::array{100.0, -20.0}, std::array{1000.0, 100.0});  // 0.1 s and 0.2 s
  EXPECT_FALSE(brake.done());
  brake.step(kPeriod);
  EXPECT_NEAR(brake.velocity(0), 95, 1e-9);
  EXPECT_NEAR(brake.velocity(1), -19, 1e-9);
  EXPECT_NEAR(brake.acceleration(0), -500, 1e-9);
  EXPECT_NEAR(brake.acceleration(1), 100, 1e-9);
  int steps = 1;
  for (; !brake.done() && steps < 100; ++steps) brake.step(kPeriod);
  EXPECT_NEAR(steps, 20, 1);
  EXPECT_EQ(brake.velocity(0), 0);
  EXPECT_EQ(brake.acceleration(1), 0);
}

TEST(Brake, JointsThatStandNeedNoTime) {
  Brake brake;
  brake.begin(std::array{0.0, 0.0}, std::array{1000.0, 100.0});
  EXPECT_TRUE(brake.done());
  EXPECT_EQ(brake.velocity(0), 0);
  EXPECT_EQ(brake.acceleration(0), 0);
}

TEST(Brake, WithoutADecelerationStandsAtOnce) {
  Brake brake;
  brake.begin(std::array{50.0}, std::array{0.0});
  brake.step(kPeriod);
  EXPECT_TRUE(brake.done());
  EXPECT_EQ(brake.velocity(0), 0);
}

TEST(Brake, BeginsAnewFromOtherVelocities) {
  Brake brake;
  brake.begin(std::array{100.0}, std::array{1000.0});
  for (int i = 0; i < 50; ++i) brake.step(kPeriod);
  brake.begin(std::array{-10.0}, std::array{100.0});
  EXPECT_FALSE(brake.done());
  brake.step(kPeriod);
  EXPECT_NEAR(brake.velocity(0), -9, 1e-9);
}

}  // namespace
}  // namespace rmac
