#pragma once

#include <span>
#include <vector>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/joints/position_correction.hpp"

namespace rmac {

/// Shafts ↔ joints: the actuator map, and what the mechanics of each joint do wrong. Real-time safe but for its making.
class Transmission {
 public:
  Transmission(const ActuatorMap& map, std::span<const ServoJoint> joints);

  [[nodiscard]] const ActuatorMap& map() const noexcept { return map_; }
  [[nodiscard]] PositionCorrection& correction(std::size_t joint) noexcept { return corrections_[joint]; }
  [[nodiscard]] const PositionCorrection& correction(std::size_t joint) const noexcept { return corrections_[joint]; }

  /// Shaft angles that put the joints there, and back.
  void shafts_for(std::span<const double> joint_positions, std::span<double> shafts) const noexcept;
  void joints_for(std::span<const double> shafts, std::span<double> joint_positions) const noexcept;
  /// Joint efforts that give these shaft torques at these joint positions; the nearest, where none gives them all.
  void efforts_for(std::span<const double> joint_positions, std::span<const double> torques,
                   std::span<double> efforts) const noexcept;

 private:
  const ActuatorMap& map_;
  std::vector<PositionCorrection> corrections_;
};

}  // namespace rmac
