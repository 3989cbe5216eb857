// The sine that SweptSineServoControlLaw puts on top of its PID.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "rmac/modules/swept_sine_servo_law.hpp"
#include "rmac/motion/joint_mechanics.hpp"

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
  modules::SweptSineServoLaw law({}, kSweep, {}, 0);
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

/// How large of `values`, a cycle of 1 ms apart, the line at `hz` is.
double line(const std::vector<double>& values, double hz) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i] * std::polar(1.0, -2 * std::numbers::pi * hz * 1e-3 * static_cast<double>(i));
  }
  return std::abs(sum);
}

/// What is left of an effort at `hz` behind the filters, as docs/servo.md has them, sampled by the bilinear rule at 1
/// kHz.
double passed(const JointMechanics& mechanics, double hz) {
  const auto over = [&](double corner) {
    return std::complex<double>(0, std::tan(std::numbers::pi * hz * 1e-3) / std::tan(std::numbers::pi * corner * 1e-3));
  };
  std::complex<double> all = 1;
  for (const Resonance& one : mechanics.resonances) {
    const auto p = over(one.frequency_hz);
    all *= (p * p + 2 * one.damping * p + 1.0) / (p * p + 2 * one.width * p + 1.0);
  }
  if (mechanics.low_pass_hz > 0) {
    const auto p = over(mechanics.low_pass_hz);
    all *= 1.0 / (p * p + std::numbers::sqrt2 * p + 1.0);
  }
  return std::abs(all);
}

/// At the odd lines of the second and third of three periods.
TEST(FilterInverse, HasTheDriveGetTheSineThatItsFiltersWouldTake) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 chance(seed);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(chance);
    };
    const Resonance notch{between(60, 400), between(0.03, 0.2), between(0.3, 1.4)};
    const JointMechanics mechanics{.resonances = {notch}, .low_pass_hz = seed % 2 == 0 ? between(100, 350) : 0};
    SweptSine sine({.effort = 40, .from_hz = 20, .to_hz = 480, .period_s = 0.5, .periods = 3, .stretches = 1});
    modules::FilterInverse inverse({{{notch.frequency_hz, notch.damping, notch.width}}, mechanics.low_pass_hz});
    std::vector<double> wanted, made;
    for (int i = 0; i < 1500; ++i) {
      const double effort = sine.step(kSteady), larger = inverse.step(effort, 1e-3);
      if (i < 500) continue;
      wanted.push_back(effort);
      made.push_back(larger);
    }
    for (double hz = 31; hz < 450; hz += 2) {
      const double left = passed(mechanics, hz), share = left * line(made, hz) / line(wanted, hz);
      EXPECT_GT(share, 0.5 * std::min(1.0, modules::FilterInverse::kMost * left)) << seed << ": " << hz;
      EXPECT_LT(share, 1.02) << seed << ": " << hz;
    }
  }
}

TEST(FilterInverse, RefusesWhatIsNoFilter) {
  const auto refused = [](const std::vector<double>& numbers) {
    const sdk::Parameter given[]{{"sweep_notches", numbers, nullptr}};
    modules::FilterInverse::Parameters read;
    std::array<char, 300> error{};
    return !modules::FilterInverse::read(given, read, error.data(), error.size()) &&
           std::string(error.data()).find("sweep_notches must have a frequency") != std::string::npos;
  };
  EXPECT_FALSE(refused({}));
  EXPECT_FALSE(refused({126, 0.05, 1.4}));
  EXPECT_FALSE(refused({126, 0.05, 1.4, 300, 0.2, 0.2}));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& numbers : std::vector<std::vector<double>>{{126, 0.05},
                                                                             {0, 0.05, 1.4},
                                                                             {126, 0, 1.4},
                                                                             {126, 1.4, 0.05},
                                                                             {kNan, 0.05, 1.4},
                                                                             {126, kNan, 1.4},
                                                                             {126, 0.05, kNan}}) {
    EXPECT_TRUE(refused(numbers)) << testing::PrintToString(numbers);
  }
}

}  // namespace
