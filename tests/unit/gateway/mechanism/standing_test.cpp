#include "gateway/mechanism/standing.hpp"

#include <gmock/gmock.h>

#include <array>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

/// A mill whose first joint has this travel; it may be off its setpoint by 2 mm.
sdk::DeviceObject mill_with(JointLimitType type) {
  sdk::DeviceObject device = TestMachine::mill();
  device.joints[0].limits.limit_type = type;
  return device;
}

bool may_stand(const sdk::DeviceObject& device, double at, bool as_measured) {
  return check_standing(device, std::array{at, 0.0, 0.0}, as_measured).has_value();
}

// Red when what is measured is held against the limits as if it were exact, or the other way round.
TEST(Standing, WhatIsMeasuredMayBeOffByTheFollowingErrorAndASetpointByRounding) {
  const sdk::DeviceObject device = mill_with(JointLimitType::Limited);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(may_stand(device, side * 51.999, true));
    EXPECT_FALSE(may_stand(device, side * 52.001, true));
    EXPECT_TRUE(may_stand(device, side * (50 + 0.9e-6), false));
    EXPECT_FALSE(may_stand(device, side * (50 + 1.1e-6), false));
  }
}

// Red when a bound is taken from the wrong side of a joint that has one only.
TEST(Standing, AJointWithoutAnEndMayStandAnywhereOnThatSide) {
  EXPECT_TRUE(may_stand(mill_with(JointLimitType::InfinitePositive), 1000, false));
  EXPECT_FALSE(may_stand(mill_with(JointLimitType::InfinitePositive), -51, false));
  EXPECT_TRUE(may_stand(mill_with(JointLimitType::InfiniteNegative), -1000, false));
  EXPECT_FALSE(may_stand(mill_with(JointLimitType::InfiniteNegative), 51, false));
  EXPECT_TRUE(may_stand(mill_with(JointLimitType::Infinite), -1000, false));
  EXPECT_TRUE(may_stand(mill_with(JointLimitType::Infinite), 1000, false));
}

TEST(Standing, NamesTheJointItsPlaceAndTheLimitsItHas) {
  sdk::DeviceObject device = TestMachine::mill();
  device.joints[1].limits.limit_type = JointLimitType::InfinitePositive;
  const auto refused = check_standing(device, std::array{0.0, -60.5, 0.0}, false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_THAT(refused.error().message,
              HasSubstr("joint 1 \"Y\" stands at -60.5000, outside of its limits -50 to infinity"));
}

}  // namespace
}  // namespace rmac::gateway
