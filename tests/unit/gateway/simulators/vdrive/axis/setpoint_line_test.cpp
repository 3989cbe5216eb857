#include "gateway/simulators/vdrive/axis/setpoint_line.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

constexpr double kLeast = -1e6, kMost = 1e6;

TEST(SetpointLine, ReachesTheSetpointWhenTheNextOneIsDueAndThenStays) {
  SetpointLine line;
  Demand demand;
  line.take(100, 0.004);
  for (const double expected : {25.0, 50.0, 75.0, 100.0}) {
    line.follow(demand, kLeast, kMost, 0.001);
    EXPECT_NEAR(demand.position, expected, 1e-9);
    EXPECT_NEAR(demand.velocity, 25'000, 1e-6);
  }
  line.follow(demand, kLeast, kMost, 0.001);
  EXPECT_EQ(demand.position, 100);
  EXPECT_EQ(demand.velocity, 0);
}

TEST(SetpointLine, KeepsWithinTheSoftwareLimits) {
  SetpointLine line;
  Demand demand;
  line.take(100, 0);
  line.follow(demand, -10, 40, 0.001);
  EXPECT_EQ(demand.position, 40);
  line.take(-100, 0);
  line.follow(demand, -10, 40, 0.001);
  EXPECT_EQ(demand.position, -10);
}

TEST(SetpointLine, StaysWhereItIsToldTo) {
  SetpointLine line;
  Demand demand;
  line.take(100, 1);
  line.stay(7);
  line.follow(demand, kLeast, kMost, 0.001);
  EXPECT_EQ(demand.position, 7);
}

}  // namespace
}  // namespace rmac::vdrive
