#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/joints/index_set.hpp"

namespace rmac {

/// Which motors move which joints, and what their drives take and tell. Found once, from the actuator map's answers to
/// an effort of 1 at each joint; constant from then on.
class Wiring {
 public:
  /// `actuators` in the order of the map.
  Wiring(const ActuatorMap& map, std::size_t joints, std::span<const ServoActuator> actuators);

  [[nodiscard]] std::size_t joints() const noexcept { return joints_; }
  [[nodiscard]] std::size_t actuators() const noexcept { return actuators_; }
  /// Actuators that this joint's effort reaches.
  [[nodiscard]] IndexSet actuators_of(std::size_t joint) const noexcept { return actuators_of_[joint]; }
  /// Joints that one of these actuators moves.
  [[nodiscard]] IndexSet joints_of(IndexSet actuators) const noexcept;
  /// 1 or -1: the shaft's sense for its joint; 0 where several joints share the shaft.
  [[nodiscard]] int sense(std::size_t actuator) const noexcept { return sense_[actuator]; }
  /// Whose shaft it is, where `sense` is not 0.
  [[nodiscard]] std::size_t joint_of(std::size_t actuator) const noexcept { return joint_of_[actuator]; }
  /// It moves one joint, which no other actuator moves.
  [[nodiscard]] bool alone(std::size_t actuator) const noexcept {
    return sense_[actuator] != 0 && actuators_of_[joint_of_[actuator]] == only(actuator);
  }

  /// Actuators whose drives take a torque; the others follow a position or a velocity themselves.
  [[nodiscard]] IndexSet torque_drives() const noexcept { return torque_drives_; }
  [[nodiscard]] bool all_take_torque() const noexcept { return torque_drives_ == first(actuators_); }
  /// The drives of this joint follow its position or velocity themselves.
  [[nodiscard]] bool follows_itself(std::size_t joint) const noexcept {
    return (actuators_of_[joint] & ~torque_drives_) != 0;
  }
  [[nodiscard]] IndexSet follow_themselves() const noexcept {
    IndexSet found = 0;
    for (std::size_t j = 0; j < joints_; ++j) found |= follows_itself(j) ? only(j) : 0;
    return found;
  }
  /// Actuators that move no joint outside of `joints`.
  [[nodiscard]] IndexSet actuators_within(IndexSet joints) const noexcept;
  /// So many cycles before this one were they where they tell in it: each actuator; and each joint, by the slowest of
  /// its actuators.
  using Delays = std::array<std::uint8_t, kMaxJoints>;
  [[nodiscard]] const Delays& actuator_delays() const noexcept { return actuator_delays_; }
  [[nodiscard]] const Delays& joint_delays() const noexcept { return joint_delays_; }

 private:
  std::size_t joints_;
  std::size_t actuators_;
  std::array<IndexSet, kMaxJoints> actuators_of_{};
  std::array<std::int8_t, kMaxJoints> sense_{};
  std::array<std::uint8_t, kMaxJoints> joint_of_{};
  IndexSet torque_drives_ = 0;
  Delays actuator_delays_{};
  Delays joint_delays_{};
};

}  // namespace rmac
