// The sine that SweptSineServoControlLaw puts on top of its PID.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

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

/// What is left of an effort at `hz` behind the filters, as docs/servo.md has them, sampled by the bilinear rule.
double passed(const JointMechanics& mechanics, double hz, double period_s = 1e-3) {
  const auto over = [&](double corner) {
    return std::complex<double>(
        0, std::tan(std::numbers::pi * hz * period_s) / std::tan(std::numbers::pi * corner * period_s));
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

/// Two or three notches, deep ones and narrow ones, some of which overlap or are the same, and a low-pass.
modules::FilterInverse::Parameters many_filters(unsigned seed) {
  std::mt19937 chance(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(chance);
  };
  modules::FilterInverse::Parameters filters{.low_pass_hz = between(80, 350)};
  for (unsigned i = 0; i < 2 + seed % 2; ++i) {
    filters.notches.push_back({between(60, 400), between(0.01, 0.2), between(0.3, 1.4)});
  }
  if (seed % 3 == 0) filters.notches[1] = filters.notches[0];
  return filters;
}

JointMechanics mechanics_of(const modules::FilterInverse::Parameters& filters) {
  JointMechanics mechanics{.low_pass_hz = filters.low_pass_hz};
  for (const auto& one : filters.notches) mechanics.resonances.push_back({one.frequency_hz, one.damping, one.width});
  return mechanics;
}

constexpr std::array kPeriods{0.00025, 0.001};

SweptSine::Parameters sweep_of(double period_s) {
  return {.effort = 40, .from_hz = 20, .to_hz = 0.495 / period_s, .period_s = 0.5, .periods = 3, .stretches = 1};
}

/// By how much it makes a steady sine at `hz` larger.
double times_larger(modules::FilterInverse inverse, double hz, double period_s) {
  double largest = 0;
  for (int i = 0; i < std::lround(0.7 / period_s); ++i) {
    const double made = inverse.step(std::sin(2 * std::numbers::pi * hz * period_s * i), period_s);
    if (i * period_s > 0.6) largest = std::max(largest, std::abs(made));
  }
  return largest;
}

TEST(FilterInverse, IsNowhereMoreThanTenTimesHoweverManyFiltersThereAre) {
  constexpr double kMost = modules::FilterInverse::kMost;
  for (const double period_s : kPeriods) {
    for (unsigned seed = 1; seed <= 9; ++seed) {
      const auto filters = many_filters(seed);
      const modules::FilterInverse inverse(filters);
      std::vector<double> places;
      for (const auto& notch : filters.notches) {
        for (const double beside : {0.9, 1.0, 1.05}) places.push_back(beside * notch.frequency_hz);
      }
      for (double hz = 23; hz < 450; hz += 67) places.push_back(hz);
      for (const double hz : places) {
        const double times = times_larger(inverse, hz, period_s), left = passed(mechanics_of(filters), hz, period_s);
        EXPECT_LE(times, kMost) << seed << ": " << hz;
        EXPECT_GT(times, 0.65 * std::min(1 / left, kMost)) << seed << ": " << hz;
        EXPECT_LE(times * left, 1.001) << seed << ": " << hz;
      }
    }
  }
}

/// What (n p² + 2 z p + 1) / (p² + 2 d p + 1) makes of `efforts`, by the bilinear rule, with the place at `hz` kept.
void filter(std::vector<double>& efforts, double n, double z, double d, double hz, double period_s) {
  const double w = std::tan(std::numbers::pi * hz * period_s), scale = 1 + 2 * d * w + w * w;
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  for (double& effort : efforts) {
    const double y = ((n + 2 * z * w + w * w) * effort + 2 * (w * w - n) * x1 + (n - 2 * z * w + w * w) * x2 -
                      2 * (w * w - 1) * y1 - (1 - 2 * d * w + w * w) * y2) /
                     scale;
    x2 = std::exchange(x1, effort);
    y2 = std::exchange(y1, y);
    effort = y;
  }
}

double loudest(const std::vector<double>& efforts) {
  return std::transform_reduce(
      efforts.begin(), efforts.end(), 0.0, [](double a, double b) { return std::max(a, b); },
      [](double one) { return std::abs(one); });
}

/// Loudest effort of the law with a joint that follows its setpoint, of which the limit is so many times the sine, and
/// what is behind the filters.
std::pair<double, double> loudest_of_law(const modules::FilterInverse::Parameters& filters, double period_s,
                                         double limit) {
  const SweptSine::Parameters sweep = sweep_of(period_s);
  modules::SweptSineServoLaw law({}, sweep, filters, 0);
  const std::array<double, 3> gains{10, 0, 0};
  EXPECT_TRUE(law.set_gains(gains));
  law.set_effort_limit(limit * sweep.effort);
  const ServoInput input{.velocity_setpoint = 5, .velocity = 5, .period_s = period_s};
  law.engage(input, 0);
  std::vector<double> efforts;
  for (int i = 0; i < std::lround(1.5 / period_s); ++i) efforts.push_back(law.update(input));
  const double before = loudest(efforts);
  for (const auto& one : filters.notches) filter(efforts, 1, one.damping, one.width, one.frequency_hz, period_s);
  filter(efforts, 0, 0, std::numbers::sqrt2 / 2, filters.low_pass_hz, period_s);
  return {before / sweep.effort, loudest(efforts) / sweep.effort};
}

TEST(SweptSineLaw, LeavesTheFeedbackAReserveBelowTheEffortLimit) {
  for (const double period_s : kPeriods) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto filters = many_filters(seed);
      for (const double limit : {20.0, 1 / 0.095}) {
        const auto [before, behind] = loudest_of_law(filters, period_s, limit);
        EXPECT_LT(before, 1.2 * std::min(0.5 * limit, modules::FilterInverse::kMost)) << seed;
        EXPECT_LT(behind, 1.2) << seed << ": it may swing a little as it comes through a notch";
      }
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
  std::vector<double> many;
  for (int i = 0; i < 8; ++i) many.insert(many.end(), {126, 0.05, 1.4});
  EXPECT_FALSE(refused(many));
  many.insert(many.end(), {126, 0.05, 1.4});
  EXPECT_TRUE(refused(many));
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
