#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gateway/animation/machine_shape.hpp"

namespace rmac::gateway::fakes {

/// Two slides: X carries the table, Z the spindle.
class Slides final : public Kinematics {
 public:
  std::size_t joint_count() const noexcept override { return 2; }
  JointType joint_type(std::size_t) const noexcept override { return JointType::Linear; }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    pose = {{joints[0] + tool.p[0], tool.p[1], joints[1] + tool.p[2]}, {0, 0, 1}};
  }
  KinematicsStatus inverse(const ToolPose&, const Frame&, std::span<const double>,
                           std::span<double>) const noexcept override {
    return KinematicsStatus::OutOfReach;
  }
  void jacobian(std::span<const double>, const Frame&, std::span<double>) const noexcept override {}
};

/// What there is to draw of such a machine.
inline std::shared_ptr<const MachineDrawing> slides_drawing(std::int64_t number = 1, std::int64_t after_cycle = 0) {
  const std::vector<std::string> chain{"X", "base", "Z"}, joints{"X", "Z"};
  MachineDrawing drawing;
  drawing.number = number;
  drawing.after_cycle = after_cycle;
  drawing.machine = "Slides";
  drawing.joints = joints;
  drawing.links.emplace(
      LinkChain::make(Slides{}, chain, joints, std::vector<std::pair<double, double>>(2, {-50, 50})).value(), chain);
  return std::make_shared<const MachineDrawing>(std::move(drawing));
}

}  // namespace rmac::gateway::fakes
