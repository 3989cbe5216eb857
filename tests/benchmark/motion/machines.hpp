#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/planner_model.hpp"

namespace rmac::bench {

/// Distance from the fork's axes to the tool tip, mm.
inline constexpr double kPivot_mm = 150;

/// Three linear axes and a fork head: A turns about x, B (carried by A) about the turned y. The tool axis is
/// (sin b, -sin a cos b, cos a cos b), the pivot is where x, y, z say, and the tip hangs below it. Not singular unless
/// b is 90 degrees.
class ForkHeadKinematics final : public Kinematics {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 5; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override {
    return joint < 3 ? JointType::Linear : JointType::Rotary;
  }
  void forward(std::span<const double> q, const Frame&, ToolPose& pose) const noexcept override {
    const double a = q[3] * kRad, b = q[4] * kRad;
    pose.axis = {std::sin(b), -std::sin(a) * std::cos(b), std::cos(a) * std::cos(b)};
    for (std::size_t i = 0; i < 3; ++i) pose.tip[i] = q[i] - kPivot_mm * (pose.axis[i] - (i == 2 ? 1 : 0));
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame&, std::span<const double>,
                                         std::span<double> q) const noexcept override {
    const auto& [i, j, k] = pose.axis;
    const double across = std::hypot(j, k);
    if (across < 1e-6) return KinematicsStatus::Singular;
    for (std::size_t n = 0; n < 3; ++n) q[n] = pose.tip[n] + kPivot_mm * (pose.axis[n] - (n == 2 ? 1 : 0));
    q[3] = std::atan2(-j, k) / kRad;
    q[4] = std::atan2(i, across) / kRad;
    return KinematicsStatus::Ok;
  }
  void jacobian(std::span<const double> q, const Frame&, std::span<double> jacobian) const noexcept override {
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    const double a = q[3] * kRad, b = q[4] * kRad;
    const double by_a[3] = {0, -std::cos(a) * std::cos(b), -std::sin(a) * std::cos(b)};
    const double by_b[3] = {std::cos(b), std::sin(a) * std::sin(b), -std::cos(a) * std::sin(b)};
    for (std::size_t i = 0; i < 3; ++i) {
      jacobian[i * 5 + i] = 1;
      jacobian[i * 5 + 3] = -kPivot_mm * by_a[i] * kRad;
      jacobian[i * 5 + 4] = -kPivot_mm * by_b[i] * kRad;
      jacobian[(i + 3) * 5 + 3] = by_a[i] * kRad;
      jacobian[(i + 3) * 5 + 4] = by_b[i] * kRad;
    }
  }

 private:
  static constexpr double kRad = std::numbers::pi / 180;
};

/// BenchXYZ, the mechanism of the figures: three axes, ±50 mm, 200 mm/s, 1000 mm/s², 10 000 mm/s³, 12 000 mm/min,
/// unless a row sets other limits.
inline PlannerModel bench_xyz(double acceleration = 1000, double jerk = 10000) {
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(modules::cartesian(3));
  for (const char* name : {"X", "Y", "Z"})
    model.joints.push_back({name, JointType::Linear, JointLimitType::Limited, -50, 50, 200, acceleration, jerk});
  model.max_feed_mm_s = 200;
  return model;
}

/// The same with a fork head; its rotary joints have the linear ones' numbers in degrees. Travel is wide enough for the
/// pivot's way above a tip inside ±50 mm.
inline PlannerModel bench_xyzab(double acceleration, double jerk) {
  PlannerModel model = bench_xyz(acceleration, jerk);
  model.kinematics = std::make_shared<ForkHeadKinematics>();
  for (auto& joint : model.joints) joint.min = -150, joint.max = 150;
  for (const char* name : {"A", "B"})
    model.joints.push_back({name, JointType::Rotary, JointLimitType::Limited, -60, 60, 200, acceleration, jerk});
  return model;
}

}  // namespace rmac::bench
