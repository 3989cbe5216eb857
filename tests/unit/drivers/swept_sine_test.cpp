// The sine that SweptSineServoControlLaw puts on top of its PID.
#include <gmock/gmock.h>

#include <cmath>

#include "rmac/modules/swept_sine_servo_law.hpp"

namespace {

using namespace rmac;
using modules::SweptSine;

constexpr SweptSine::Parameters kSweep{
    .effort = 40, .from_hz = 20, .to_hz = 450, .full_hz = 100, .period_s = 0.25, .periods = 3, .stretches = 4};
constexpr ServoInput kSteady{.velocity_setpoint = 5};

std::vector<double> efforts(SweptSine& sine, int cycles, const ServoInput& input) {
  std::vector<double> all;
  for (int i = 0; i < cycles; ++i) all.push_back(sine.step(input));
  return all;
}

TEST(SweptSine, IsTheSameWithTheOtherSignInEachPeriodAndEnds) {
  SweptSine sine(kSweep);
  const auto all = efforts(sine, 1000, kSteady);
  for (std::size_t i = 0; i < 250; ++i) {
    EXPECT_EQ(all[250 + i], -all[i]);
    EXPECT_EQ(all[500 + i], all[i]);
    EXPECT_EQ(all[750 + i], 0);
  }
  EXPECT_EQ(all[0], 0) << "it begins without a step";
}

TEST(SweptSine, GrowsUpToItsFullFrequencyAndStaysWithinItsEffort) {
  SweptSine sine(kSweep);
  const auto all = efforts(sine, 250, kSteady);
  double largest = 0;
  for (std::size_t i = 0; i < 250; ++i) {
    const double hz = 20 + (450 - 20) * static_cast<double>(i) / 250;
    EXPECT_LE(std::abs(all[i]), 40 * std::min(hz / 100, 1.0) + 1e-9) << i;
    largest = std::max(largest, std::abs(all[i]));
  }
  EXPECT_GT(largest, 38);
}

TEST(SweptSine, IsThereAtASteadySpeedOnlyAndBeginsAnew) {
  SweptSine sine(kSweep);
  const auto first = efforts(sine, 750, kSteady);
  for (const ServoInput& other : {ServoInput{}, ServoInput{.velocity_setpoint = 5, .acceleration_setpoint = 20},
                                  ServoInput{.acceleration_setpoint = -20}}) {
    EXPECT_THAT(efforts(sine, 3, other), testing::Each(0.0));
    EXPECT_EQ(efforts(sine, 750, kSteady), first);
  }
}

TEST(SweptSine, IsNoMoreAfterItsStretchesOrOneThatWasBrokenOff) {
  SweptSine through(kSweep);
  for (int stretch = 0; stretch < 4; ++stretch) {
    EXPECT_NE(efforts(through, 750, kSteady)[100], 0);
    EXPECT_EQ(through.step({}), 0);
  }
  EXPECT_THAT(efforts(through, 750, kSteady), testing::Each(0.0));
  SweptSine broken_off(kSweep);
  efforts(broken_off, 749, kSteady);
  EXPECT_EQ(broken_off.step({}), 0);
  EXPECT_THAT(efforts(broken_off, 750, kSteady), testing::Each(0.0));
}

TEST(SweptSine, IsNoMoreWhereNoneBeganWithinAMinute) {
  const ServoInput rest{.period_s = 0.001};
  SweptSine waits(kSweep);
  efforts(waits, 59'900, rest);
  EXPECT_NE(efforts(waits, 750, kSteady)[100], 0);
  efforts(waits, 59'900, rest);
  EXPECT_NE(efforts(waits, 750, kSteady)[100], 0) << "the minute begins anew behind each stretch";
  efforts(waits, 60'100, rest);
  EXPECT_THAT(efforts(waits, 750, kSteady), testing::Each(0.0)) << "whoever wanted it is gone";
}

TEST(SweptSineLaw, StaysWithinTheEffortLimit) {
  modules::SweptSineServoLaw law({}, kSweep, 0);
  const std::array<double, 3> gains{10, 0, 0};
  ASSERT_TRUE(law.set_gains(gains));
  law.set_effort_limit(15);
  law.engage(kSteady, 0);
  double largest = 0;
  for (int i = 0; i < 750; ++i) {
    largest = std::max(largest, std::abs(law.update({.position_setpoint = 0.5, .velocity_setpoint = 5})));
  }
  EXPECT_EQ(largest, 15);
}

}  // namespace
