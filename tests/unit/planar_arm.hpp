#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "rmac/motion/planner_model.hpp"

namespace rmac::test {

/// What a planar arm may do wrong.
enum class ArmFault {
  None,
  ClampsItsReach,   ///< a pose beyond its reach has the joints of the stretched arm
  LiesOfItsRates,   ///< the Jacobian is half of what it is
  LosesItsNumbers,  ///< after some thousand calls the inverse gives no number
  Misses            ///< the inverse leads the tool a tenth of a millimetre beside its pose, near the base
};

/// A shoulder and an elbow about upright axes, and a quill: 200 and 150 mm long, so that nothing nearer to the base
/// than 50 mm is reached. Its tools point upright.
class PlanarArm final : public Kinematics {
 public:
  static constexpr double kUpper_mm = 200, kLower_mm = 150;

  explicit PlanarArm(ArmFault fault = ArmFault::None) : fault_(fault) {}

  [[nodiscard]] std::size_t joint_count() const noexcept override { return 3; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override {
    return joint == 2 ? JointType::Linear : JointType::Rotary;
  }
  void forward(std::span<const double> q, const Frame& tool, ToolPose& pose) const noexcept override {
    const double a = q[0] * kRad, b = a + q[1] * kRad;
    pose.tip = {kUpper_mm * std::cos(a) + kLower_mm * std::cos(b), kUpper_mm * std::sin(a) + kLower_mm * std::sin(b),
                q[2] + tool.p[2]};
    pose.axis = {0, 0, 1};
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> q) const noexcept override {
    std::array<double, 6> all{};
    if (solutions(pose, tool, seed, all) == 0) return KinematicsStatus::OutOfReach;
    std::copy_n(all.begin(), 3, q.begin());
    if (fault_ == ArmFault::LosesItsNumbers && ++calls_ > 20'000) q[0] = std::nan("");
    return KinematicsStatus::Ok;
  }
  [[nodiscard]] std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                      std::span<double> out) const noexcept override {
    const double x = pose.tip[0], y = pose.tip[1], z = pose.tip[2] - tool.p[2];
    double cosine = (x * x + y * y - kUpper_mm * kUpper_mm - kLower_mm * kLower_mm) / (2 * kUpper_mm * kLower_mm);
    if (fault_ == ArmFault::ClampsItsReach) cosine = std::clamp(cosine, -1.0, 1.0);
    const double leans = std::hypot(pose.axis[0], pose.axis[1], pose.axis[2] - 1);
    if (!(std::abs(cosine) <= 1 + 1e-12) || !(leans < 1e-9) || !std::isfinite(z)) return 0;
    const double elbow = std::acos(std::clamp(cosine, -1.0, 1.0));
    std::array<std::array<double, 3>, 2> found{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double e = i == 0 ? elbow : -elbow;
      const double s = std::atan2(y, x) - std::atan2(kLower_mm * std::sin(e), kUpper_mm + kLower_mm * std::cos(e));
      found[i] = {near(s / kRad, seed[0]), near(e / kRad, seed[1]), z};
      constexpr double kNearTheBase_mm = 150, kBeside_mm = 0.1;
      if (fault_ == ArmFault::Misses && std::hypot(x, y) < kNearTheBase_mm) found[i][2] += kBeside_mm;
    }
    const auto way = [&](const auto& one) { return std::hypot(one[0] - seed[0], one[1] - seed[1]); };
    if (way(found[1]) < way(found[0])) std::swap(found[0], found[1]);
    for (std::size_t i = 0; i < 2 && (i + 1) * 3 <= out.size(); ++i) std::copy_n(found[i].begin(), 3, &out[i * 3]);
    return 2;
  }
  void jacobian(std::span<const double> q, const Frame&, std::span<double> rows) const noexcept override {
    const double a = q[0] * kRad, b = a + q[1] * kRad, part = fault_ == ArmFault::LiesOfItsRates ? 0.5 : 1;
    std::fill(rows.begin(), rows.end(), 0.0);
    const double dx = -kLower_mm * std::sin(b), dy = kLower_mm * std::cos(b);
    rows[0] = part * kRad * (dx - kUpper_mm * std::sin(a));
    rows[1] = part * kRad * dx;
    rows[3] = part * kRad * (dy + kUpper_mm * std::cos(a));
    rows[4] = part * kRad * dy;
    rows[8] = 1;
  }

 private:
  static constexpr double kRad = std::numbers::pi / 180;
  static double near(double degrees, double seed) noexcept { return seed + std::remainder(degrees - seed, 360); }

  ArmFault fault_;
  mutable int calls_ = 0;
};

inline PlannerModel planar_arm(ArmFault fault = ArmFault::None) {
  PlannerModel model;
  model.kinematics = std::make_shared<PlanarArm>(fault);
  model.joints = {{"Shoulder", JointType::Rotary, JointLimitType::Limited, -170, 170, 180, 600, 6000},
                  {"Elbow", JointType::Rotary, JointLimitType::Limited, -150, 150, 180, 600, 6000},
                  {"Z", JointType::Linear, JointLimitType::Limited, -100, 0, 200, 2000, 20000}};
  model.max_feed_mm_s = 100;
  return model;
}

}  // namespace rmac::test
