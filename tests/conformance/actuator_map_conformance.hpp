#pragma once

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "rmac/motion/ports/actuator_map.hpp"

namespace rmac::conformance {

/// What every actuator map must keep, over seeded random joints within ±`reach`: positions go there and back, shaft
/// velocities belong to the positions, and the power at the shafts is the power at the joints. (Joint power is N ·
/// mm/s, a thousandth of a watt; `joint_power_scale` is 1e-3 for linear joints, π/180 for rotary ones.)
inline void check_actuator_map(const ActuatorMap& map, double reach, const std::vector<double>& joint_power_scale,
                               unsigned seed = 1, int samples = 1000) {
  const std::size_t n = map.joint_count();
  const std::size_t m = map.actuator_count();
  ASSERT_EQ(joint_power_scale.size(), n);
  std::mt19937 random(seed);
  std::uniform_real_distribution<> within(-reach, reach);
  for (int i = 0; i < samples && !testing::Test::HasFailure(); ++i) {
    std::vector<double> joints(n), efforts(n), shafts(m), back(n), torques(m), rates(m), joint_rates(n);
    for (std::size_t j = 0; j < n; ++j) {
      joints[j] = within(random);
      efforts[j] = within(random);
    }
    map.actuator_positions(joints, shafts);
    map.joint_positions(shafts, back);
    for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(back[j], joints[j], 1e-9 * reach);

    constexpr double kStep = 1e-5;
    std::vector<double> above(m), below(m), joint_speed(n);
    std::vector<double> up = joints;
    std::vector<double> down = joints;
    for (std::size_t j = 0; j < n; ++j) {
      joint_speed[j] = within(random);
      up[j] += kStep * joint_speed[j];
      down[j] -= kStep * joint_speed[j];
    }
    map.actuator_positions(up, above);
    map.actuator_positions(down, below);
    for (std::size_t a = 0; a < m; ++a) rates[a] = (above[a] - below[a]) / (2 * kStep);
    map.joint_velocities(shafts, rates, joint_rates);
    for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(joint_rates[j], joint_speed[j], 1e-5 * reach);

    map.actuator_efforts(joints, efforts, torques);
    double at_joints = 0;
    double at_shafts = 0;
    for (std::size_t j = 0; j < n; ++j) at_joints += efforts[j] * joint_speed[j] * joint_power_scale[j];
    for (std::size_t a = 0; a < m; ++a) at_shafts += torques[a] * rates[a];
    EXPECT_NEAR(at_shafts, at_joints, 1e-6 * reach * reach * 1e-3 * static_cast<double>(n));
  }
}

}  // namespace rmac::conformance
