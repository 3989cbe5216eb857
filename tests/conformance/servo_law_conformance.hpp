#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::conformance {

/// What every servo law must keep, with gains that it takes: its gains are named, wrong ones change nothing, its output
/// stays within the limit, engaging continues from the effort given, NaN comes out where NaN goes in and leaves nothing
/// behind.
class ServoLawConformance {
 public:
  ServoLawConformance(ServoLaw& law, std::vector<double> gains) : law_(law), gains_(std::move(gains)) {}

  void check(unsigned seed = 1) {
    check_gains();
    if (!testing::Test::HasFailure()) check_bounded(seed);
    if (!testing::Test::HasFailure()) check_engage(seed);
    if (!testing::Test::HasFailure()) check_nan();
  }

 private:
  void check_gains() {
    ASSERT_EQ(law_.gains().size(), gains_.size());
    for (const GainInfo& gain : law_.gains()) {
      EXPECT_STRNE(gain.name, "");
      EXPECT_STRNE(gain.unit, "");
    }
    ASSERT_TRUE(law_.set_gains(gains_));
    std::vector<double> wrong = gains_;
    wrong.push_back(1);
    EXPECT_FALSE(law_.set_gains(wrong));
    wrong = gains_;
    wrong[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(law_.set_gains(wrong));
    wrong[0] = -1;
    EXPECT_FALSE(law_.set_gains(wrong));
  }

  ServoInput random_input(std::mt19937& random, double size) const {
    std::uniform_real_distribution<> value(-size, size);
    return {.position_setpoint = value(random),
            .velocity_setpoint = value(random),
            .acceleration_setpoint = value(random),
            .position = value(random),
            .velocity = value(random)};
  }

  void check_bounded(unsigned seed) {
    std::mt19937 random(seed);
    constexpr double kLimit = 100;
    law_.set_effort_limit(kLimit);
    law_.engage({}, 0);
    for (int i = 0; i < 10000; ++i) {
      const double effort = law_.update(random_input(random, i % 2 == 0 ? 1e-3 : 1e6));
      ASSERT_LE(std::abs(effort), kLimit) << "in cycle " << i;
    }
  }

  void check_engage(unsigned seed) {
    std::mt19937 random(seed);
    law_.set_effort_limit(100);
    for (int i = 0; i < 1000; ++i) {
      const ServoInput input = random_input(random, 10);
      const double effort = std::uniform_real_distribution<>(-100, 100)(random);
      law_.engage(input, effort);
      ASSERT_NEAR(law_.update(input), effort, 1e-6) << "the output jumps when the law is engaged";
    }
  }

  void check_nan() {
    law_.set_effort_limit(100);
    const ServoInput rest;
    law_.engage(rest, 10);
    ServoInput bad = rest;
    bad.position = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(law_.update(bad)));
    law_.engage(rest, 10);
    EXPECT_NEAR(law_.update(rest), 10, 1e-9) << "a NaN stayed in the law's state";
  }

  ServoLaw& law_;
  std::vector<double> gains_;
};

}  // namespace rmac::conformance
