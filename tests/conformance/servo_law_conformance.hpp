#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::conformance {

/// What every servo law must keep, with two sets of gains that it takes, over seeded random inputs: its gains are
/// named, wrong ones change nothing, its output stays within the limit, engaging continues from the effort given, new
/// gains do not make it jump, NaN and infinity come out as no number and leave nothing behind.
class ServoLawConformance {
 public:
  ServoLawConformance(ServoLaw& law, std::vector<double> gains, std::vector<double> other_gains)
      : law_(law), gains_(std::move(gains)), other_gains_(std::move(other_gains)) {}

  void check(unsigned seed = 1) {
    check_gains();
    if (!testing::Test::HasFailure()) check_bounded(seed);
    if (!testing::Test::HasFailure()) check_engage(seed);
    if (!testing::Test::HasFailure()) check_resting();
    if (!testing::Test::HasFailure()) check_new_gains(seed);
    if (!testing::Test::HasFailure()) check_refused_gains(seed);
    if (!testing::Test::HasFailure()) check_nan(seed);
  }

 private:
  static constexpr double kLimit = 100;

  void check_gains() {
    ASSERT_EQ(law_.gains().size(), gains_.size());
    for (const GainInfo& gain : law_.gains()) {
      EXPECT_STRNE(gain.name, "");
      EXPECT_STRNE(gain.unit, "");
    }
    ASSERT_TRUE(law_.set_gains(other_gains_));
    ASSERT_TRUE(law_.set_gains(gains_));
  }

  static ServoInput random_input(std::mt19937& random, double size) {
    std::uniform_real_distribution<> value(-size, size);
    return {.position_setpoint = value(random),
            .velocity_setpoint = value(random),
            .acceleration_setpoint = value(random),
            .position = value(random),
            .velocity = value(random)};
  }
  static double random_effort(std::mt19937& random) {
    return std::uniform_real_distribution<>(-kLimit, kLimit)(random);
  }

  void check_bounded(unsigned seed) {
    std::mt19937 random(seed);
    law_.set_effort_limit(kLimit);
    law_.engage({}, 0);
    for (int i = 0; i < 10000; ++i) {
      const double effort = law_.update(random_input(random, i % 2 == 0 ? 1e-3 : 1e6));
      ASSERT_LE(std::abs(effort), kLimit) << "in cycle " << i;
      if (i % 100 == 0) {
        ASSERT_TRUE(law_.set_gains(i % 200 == 0 ? other_gains_ : gains_));
      }
    }
    law_.engage(random_input(random, 1), 10 * kLimit);
    EXPECT_LE(std::abs(law_.update(random_input(random, 1))), kLimit) << "engaged with an effort beyond the limit";
    ASSERT_TRUE(law_.set_gains(gains_));
  }

  void check_engage(unsigned seed) {
    std::mt19937 random(seed);
    law_.set_effort_limit(kLimit);
    for (int i = 0; i < 1000; ++i) {
      const ServoInput input = random_input(random, 10);
      const double effort = random_effort(random);
      law_.engage(input, effort);
      ASSERT_NEAR(law_.update(input), effort, 1e-6) << "the output jumps when the law is engaged";
      for (int cycle = 0; cycle < i % 5; ++cycle) (void)law_.update(random_input(random, 10));
    }
  }

  /// What holds the joint at rest is what the law puts out there, and goes on with.
  void check_resting() {
    const double resting = law_.resting_effort();
    ASSERT_TRUE(std::isfinite(resting));
    law_.set_effort_limit(std::abs(resting) + kLimit);
    law_.engage({}, resting);
    for (int i = 0; i < 1000; ++i) ASSERT_NEAR(law_.update({}), resting, 1e-6) << "in cycle " << i;
  }

  /// With steady input the step in which gains change is no larger than the steps before and after it together: those
  /// of the integral, and of an offset that fades.
  void check_new_gains(unsigned seed) {
    std::mt19937 random(seed);
    law_.set_effort_limit(kLimit);
    for (int i = 0; i < 1000; ++i) {
      const ServoInput input = random_input(random, 0.01);
      law_.engage(input, random_effort(random) / 2);  // the limit is not to hide a jump
      const double first = law_.update(input);
      const double second = law_.update(input);
      ASSERT_TRUE(law_.set_gains(i % 3 == 0 ? gains_ : other_gains_));
      const double third = law_.update(input);
      const double fourth = law_.update(input);
      const double natural = std::abs(second - first) + std::abs(fourth - third);
      ASSERT_LE(std::abs(third - second), 1.01 * natural + 1e-6) << "the output jumps with new gains, sample " << i;
    }
    ASSERT_TRUE(law_.set_gains(gains_));
  }

  void check_refused_gains(unsigned seed) {
    std::mt19937 random(seed);
    const ServoInput input = random_input(random, 0.01);
    std::vector<std::vector<double>> wrong(4, gains_);
    wrong[0].push_back(1);
    wrong[1].pop_back();
    wrong[2].front() = -1;
    wrong[3].back() = std::numeric_limits<double>::quiet_NaN();
    law_.engage(input, 5);
    const double first = law_.update(input);
    const double step = law_.update(input) - first;
    law_.engage(input, 5);
    ASSERT_EQ(law_.update(input), first);
    for (const std::vector<double>& values : wrong) EXPECT_FALSE(law_.set_gains(values));
    EXPECT_EQ(law_.update(input) - first, step) << "gains that were refused changed something";
  }

  void check_nan(unsigned seed) {
    constexpr double ServoInput::*kFields[] = {&ServoInput::position_setpoint, &ServoInput::velocity_setpoint,
                                               &ServoInput::acceleration_setpoint, &ServoInput::position,
                                               &ServoInput::velocity};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::mt19937 random(seed);
    for (const auto field : kFields) {
      for (const double value : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
        const ServoInput good = random_input(random, 0.01);
        ServoInput bad = good;
        bad.*field = value;
        const double effort = random_effort(random);
        law_.engage(good, effort);
        EXPECT_FALSE(std::isfinite(law_.update(bad)));
        EXPECT_NEAR(law_.update(good), effort, 1e-6) << "what was no number stayed in the law's state";
      }
    }
  }

  ServoLaw& law_;
  std::vector<double> gains_, other_gains_;
};

}  // namespace rmac::conformance
