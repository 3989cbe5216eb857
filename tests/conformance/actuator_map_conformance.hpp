#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rmac/motion/ports/actuator_map.hpp"

namespace rmac::conformance {

/// One joint of a map under test. Joint power is effort · speed · `power_scale` watts: 1e-3 for mm and N, π/180 for
/// degrees and N·m.
struct MappedJoint {
  double min, max, power_scale;
};

/// What every actuator map must keep, over seeded random joints within their travel: positions go there and back, shaft
/// velocities belong to the positions (by finite differences), efforts are linear, every joint's effort reaches a
/// shaft, and the power at the shafts is the power at the joints.
class ActuatorMapConformance {
 public:
  ActuatorMapConformance(const ActuatorMap& map, std::vector<MappedJoint> joints)
      : map_(map), joints_(std::move(joints)), shafts_(map.actuator_count()) {}

  void check(unsigned seed = 1, int samples = 1000) {
    ASSERT_EQ(joints_.size(), map_.joint_count());
    random_.seed(seed);
    for (int i = 0; i < samples && !testing::Test::HasFailure(); ++i) {
      const Values at = random_joints();
      check_inverse(at);
      check_velocities_and_power(at);
      check_efforts(at);
    }
  }

 private:
  using Values = std::vector<double>;

  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  /// Far enough from the ends of travel for differences to stay within.
  Values random_joints() {
    Values values;
    for (const MappedJoint& joint : joints_) {
      const double margin = 2 * kStepS * speed(joint);
      values.push_back(random(joint.min + margin, joint.max - margin));
    }
    return values;
  }
  static double speed(const MappedJoint& joint) { return joint.max - joint.min; }
  Values shafts_at(const Values& joints) const {
    Values shafts(shafts_);
    map_.actuator_positions(joints, shafts);
    return shafts;
  }

  void check_inverse(const Values& at) {
    Values back(at.size());
    map_.joint_positions(shafts_at(at), back);
    for (std::size_t j = 0; j < at.size(); ++j) {
      EXPECT_NEAR(back[j], at[j], 1e-9 * speed(joints_[j])) << "joint " << j << " does not come back";
    }
  }

  void check_velocities_and_power(const Values& at) {
    const std::size_t n = at.size();
    Values rates(n), efforts(n), up(n), down(n);
    for (std::size_t j = 0; j < n; ++j) {
      rates[j] = random(-speed(joints_[j]), speed(joints_[j]));
      efforts[j] = random(-100, 100);
      up[j] = at[j] + kStepS * rates[j];
      down[j] = at[j] - kStepS * rates[j];
    }
    const Values above = shafts_at(up), below = shafts_at(down);
    Values shaft_rates(shafts_), found(n), torques(shafts_);
    for (std::size_t a = 0; a < shafts_; ++a) shaft_rates[a] = (above[a] - below[a]) / (2 * kStepS);
    map_.joint_velocities(shafts_at(at), shaft_rates, found);
    map_.actuator_efforts(at, efforts, torques);
    double at_joints = 0, at_shafts = 0, size = 0;
    for (std::size_t j = 0; j < n; ++j) {
      EXPECT_NEAR(found[j], rates[j], 1e-5 * speed(joints_[j])) << "joint " << j << " at " << at[j];
      at_joints += efforts[j] * rates[j] * joints_[j].power_scale;
      size += std::abs(efforts[j] * rates[j] * joints_[j].power_scale);
    }
    for (std::size_t a = 0; a < shafts_; ++a) at_shafts += torques[a] * shaft_rates[a];
    EXPECT_NEAR(at_shafts, at_joints, 1e-5 * size) << "power is lost or made, joint 0 at " << at[0];
  }

  void check_efforts(const Values& at) {
    Values first(at.size()), second(at.size()), sum(at.size());
    for (std::size_t j = 0; j < at.size(); ++j) {
      first[j] = random(-100, 100);
      second[j] = random(-100, 100);
      sum[j] = first[j] + second[j];
      Values unit(at.size()), reached(shafts_);
      unit[j] = 1;
      map_.actuator_efforts(at, unit, reached);
      double any = 0;
      for (const double torque : reached) any += std::abs(torque);
      EXPECT_GT(any, 0) << "no shaft feels an effort of joint " << j;
    }
    Values of_first(shafts_), of_second(shafts_), of_sum(shafts_);
    map_.actuator_efforts(at, first, of_first);
    map_.actuator_efforts(at, second, of_second);
    map_.actuator_efforts(at, sum, of_sum);
    for (std::size_t a = 0; a < shafts_; ++a) {
      EXPECT_NEAR(of_sum[a], of_first[a] + of_second[a], 1e-9 * (1 + std::abs(of_first[a]) + std::abs(of_second[a])));
    }
  }

  static constexpr double kStepS = 1e-5;
  const ActuatorMap& map_;
  std::vector<MappedJoint> joints_;
  std::size_t shafts_;
  std::mt19937 random_;
};

}  // namespace rmac::conformance
