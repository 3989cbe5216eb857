#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::modules {

/// X, Y and, with three axes, Z along the machine frame, tool interface parallel to it. With two axes the machine's
/// plane z = 0 is where the tool interface stands, and poses off it are out of reach.
template <std::size_t kAxes>
class CartesianKinematics final : public Kinematics {
  static_assert(kAxes == 2 || kAxes == 3);

 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return kAxes; }
  [[nodiscard]] JointType joint_type(std::size_t /*joint*/) const noexcept override { return JointType::Linear; }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    pose.tip = tool.p;
    for (std::size_t i = 0; i < kAxes; ++i) pose.tip[i] += joints[i];
    pose.axis = z_axis(tool);
  }

  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> /*seed*/,
                                         std::span<double> joints) const noexcept override {
    const Vector axis = z_axis(tool);
    const double turned = std::hypot(pose.axis[0] - axis[0], pose.axis[1] - axis[1], pose.axis[2] - axis[2]);
    if (!(turned <= kAxisTolerance)) return KinematicsStatus::OutOfReach;
    for (std::size_t i = kAxes; i < 3; ++i) {
      if (!(std::abs(pose.tip[i] - tool.p[i]) <= kPlaneTolerance)) return KinematicsStatus::OutOfReach;
    }
    for (std::size_t i = 0; i < kAxes; ++i) joints[i] = pose.tip[i] - tool.p[i];
    return KinematicsStatus::Ok;
  }

  void jacobian(std::span<const double> /*joints*/, const Frame& /*tool*/,
                std::span<double> jacobian) const noexcept override {
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    for (std::size_t i = 0; i < kAxes; ++i) jacobian[i * kAxes + i] = 1;
  }

 private:
  static constexpr double kAxisTolerance = 1e-6;   ///< of a unit axis; the tool cannot turn
  static constexpr double kPlaneTolerance = 1e-6;  ///< mm
};

}  // namespace rmac::modules
