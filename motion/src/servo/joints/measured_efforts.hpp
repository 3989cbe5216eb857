#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/wiring.hpp"

namespace rmac {

/// What the motors push the joints with, as their drives measure it (6077h): torques through the actuator map, friction
/// of the transmission included. Real-time safe but for its making.
class MeasuredEfforts {
 public:
  /// All must outlive it. `actuators` in the order of the map.
  MeasuredEfforts(const ActuatorMap& map, const Wiring& wiring, std::span<const ServoActuator> actuators);

  /// One cycle: what the drives told, at these joint positions.
  void read(std::span<const double> joints) noexcept;
  /// All drives that have a part in the joint's effort tell their torque.
  [[nodiscard]] bool told(std::size_t joint) const noexcept { return has(told_, joint); }
  /// N or N·m; the nearest, where no effort explains the torques of all of the joint's motors.
  [[nodiscard]] double operator[](std::size_t joint) const noexcept { return effort_[joint]; }

 private:
  void find_groups() noexcept;
  void read_group(IndexSet joints, std::span<const double> torques) noexcept;

  const ActuatorMap& map_;
  const Wiring& wiring_;
  std::span<const ServoActuator> actuators_;
  IndexSet told_ = 0;
  /// Joints that share motors, directly or by way of others; each joint is in one group.
  std::array<IndexSet, kMaxJoints> group_of_{};
  std::array<std::uint8_t, kMaxJoints> place_{};  ///< of the joint in its group
  std::size_t largest_group_ = 0;
  /// By place of a joint in its group, then by actuator: torque a unit of effort. One question to the map answers for
  /// one joint of every group.
  std::array<std::array<double, kMaxJoints>, kMaxJoints> torque_of_{};
  std::array<double, kMaxJoints> effort_{};
};

}  // namespace rmac
