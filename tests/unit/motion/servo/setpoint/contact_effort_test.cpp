#include "servo/setpoint/contact_effort.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "unit/motion/servo/period.hpp"

namespace rmac::servo_test {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

/// A part that is pressed with what pushes, a cycle later, on top of what it is pressed with besides.
struct Pressed {
  ContactEffort effort{kPeriod};
  double pushed = 0;

  double step(double wanted, double besides, const ContactEffort::Limits& limits) {
    const double force = pushed + besides;
    pushed = effort.step(wanted - force, limits);
    return force;
  }
};

TEST(ContactEffort, MakesTheForceTheWantedOneWithLittleBeyondIt) {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    const double wanted = std::uniform_real_distribution(-300.0, 300.0)(random);
    const double besides = std::uniform_real_distribution(-50.0, 50.0)(random);
    const ContactEffort::Limits limits{.bandwidth_rad_s = kAny, .largest_error = 0.1 * std::abs(wanted)};
    Pressed part;
    double beyond = 0;
    for (int k = 0; k < 1000; ++k) {
      const double force = part.step(wanted, besides, limits);
      beyond = std::max(beyond, std::copysign(1.0, wanted - besides) * (force - wanted));
      if (k <= 500) continue;
      ASSERT_NEAR(force, wanted, 0.01 * std::abs(wanted) + 0.01) << besides;
    }
    EXPECT_LE(beyond, 0.1 * std::abs(wanted - besides) + 0.02 * std::abs(wanted));
  }
}

// A part that rises presses ever more: the outer integral leaves no error.
TEST(ContactEffort, LeavesNoErrorWhereThePartRises) {
  Pressed part;
  double force = 0;
  for (int k = 0; k < 4000; ++k) force = part.step(-100, -0.05 * k, {.bandwidth_rad_s = kAny, .largest_error = 10});
  EXPECT_NEAR(force, -100, 0.1);
}

TEST(ContactEffort, IsAsSlowAsItIsAskedToBe) {
  const auto after = [](double bandwidth) {
    Pressed part;
    for (int k = 0; k < 50; ++k) part.step(100, 0, {.bandwidth_rad_s = bandwidth, .largest_error = 10});
    return part.pushed;
  };
  EXPECT_NEAR(after(5), 100 * (1 - std::exp(-0.25)), 5);
  EXPECT_GT(after(kAny), 80);
  EXPECT_EQ(after(40), after(kAny)) << "nor is it faster than its cycles let it be";
}

// Its mechanics do not become faster with its cycles; what is behind a slow cycle is slower.
TEST(ContactEffort, TakesAsLongWhateverTheCycleAndLongerWhereThatIsLong) {
  const auto after = [](double period_s, double time_s) {
    ContactEffort effort(period_s);
    double pushed = 0;
    for (double t = 0; t < time_s; t += period_s)
      pushed = effort.step(100 - pushed, {.bandwidth_rad_s = kAny, .largest_error = 10});
    return pushed;
  };
  EXPECT_NEAR(after(0.00025, 0.03), after(0.001, 0.03), 5);
  EXPECT_NEAR(after(0.004, 0.12), after(0.001, 0.03), 5);
  EXPECT_LT(after(0.004, 0.03), 0.5 * after(0.001, 0.03));
}

TEST(ContactEffort, StandsStillWhereItMayNotGrowAndComesBackAtOnce) {
  ContactEffort effort(kPeriod);
  ContactEffort::Limits limits{.bandwidth_rad_s = kAny, .largest_error = 10};
  double before = 0;
  for (int k = 0; k < 100; ++k) before = effort.step(100, limits);
  limits.no_more = true;
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(effort.step(100, limits), before);
  double last = before;
  for (int k = 0; k < 100; ++k) last = effort.step(-100, limits);
  EXPECT_LT(last, before - 200) << "the other way is free";
}

TEST(ContactEffort, GivesUpWhatItGainedOnASlopeWhileItMayNotGrow) {
  ContactEffort effort(kPeriod);
  ContactEffort::Limits limits{.bandwidth_rad_s = kAny, .largest_error = 10};
  for (int k = 0; k < 2000; ++k) (void)effort.step(2, limits);
  limits.no_more = true;
  const double before = effort.step(0, limits);
  for (int k = 0; k < 10'000; ++k) (void)effort.step(-0.5, limits);
  EXPECT_LT(effort.step(-0.5, limits), before - 1) << "a small error the other way comes through";
}

TEST(ContactEffort, BeginsWithNothing) {
  ContactEffort effort(kPeriod);
  for (int k = 0; k < 100; ++k) (void)effort.step(100, {.bandwidth_rad_s = kAny, .largest_error = 10});
  effort.begin();
  EXPECT_EQ(effort.step(0, {.bandwidth_rad_s = kAny}), 0);
}

}  // namespace
}  // namespace rmac::servo_test
