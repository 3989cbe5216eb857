#pragma once

#include <span>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// Port: joints ↔ actuators (ball screw, gear, gantry or differential pair, linkage; dissertation 3.2.1).
/// Joint side: mm, mm/s, N (linear) or deg, deg/s, N·m (rotary). Actuator side, at the motor shaft: rad, rad/s, N·m.
/// Counts are not here: `DriveScale` turns the words of a drive into shaft values. Stateless, const, real-time safe.
class ActuatorMap {
 public:
  virtual ~ActuatorMap() = default;
  [[nodiscard]] virtual std::size_t joint_count() const noexcept = 0;
  [[nodiscard]] virtual std::size_t actuator_count() const noexcept = 0;

  /// Shaft angles for joint positions.
  virtual void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept = 0;
  /// Joint positions for shaft angles: the inverse of `actuator_positions`.
  virtual void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept = 0;
  /// Joint velocities for shaft velocities at the given shaft angles.
  virtual void joint_velocities(std::span<const double> actuators, std::span<const double> actuator_velocities,
                                std::span<double> joint_velocities) const noexcept = 0;
  /// Shaft torques for joint efforts at the given joint positions: power is conserved, friction belongs to the plant.
  virtual void actuator_efforts(std::span<const double> joints, std::span<const double> joint_efforts,
                                std::span<double> actuator_efforts) const noexcept = 0;
};

}  // namespace rmac
