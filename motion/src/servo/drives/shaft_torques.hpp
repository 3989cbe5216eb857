#pragma once

#include <array>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// What each motor is to turn with, in N·m at its shaft. Real-time safe.
class ShaftTorques {
 public:
  ShaftTorques(const ActuatorMap& map, std::size_t actuators) noexcept : map_(map), actuators_(actuators) {}

  /// The torques that give the joints their efforts at these positions. Where there is no number for a motor, that is a
  /// fault, and none has a torque.
  void make(std::span<const double> joints, std::span<const double> efforts, FaultSink& faults) noexcept;
  void let_go() noexcept { torque_.fill(0); }
  /// As another loop left it.
  void take_over(std::size_t actuator, double torque_nm) noexcept { torque_[actuator] = torque_nm; }

  [[nodiscard]] double operator[](std::size_t actuator) const noexcept { return torque_[actuator]; }
  [[nodiscard]] std::span<const double> all() const noexcept { return {torque_.data(), actuators_}; }

 private:
  const ActuatorMap& map_;
  std::size_t actuators_;
  std::array<double, kMaxJoints> torque_{};
};

}  // namespace rmac
