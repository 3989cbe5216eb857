#pragma once

#include <array>
#include <span>
#include <vector>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/drives/cogging_map.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"

namespace rmac {

/// What each motor is to turn with, in N·m at its shaft. Real-time safe.
class ShaftTorques {
 public:
  /// Both must outlive it.
  ShaftTorques(const ActuatorMap& map, std::span<const ServoActuator> actuators, double period_s);

  /// The torques that give the joints their efforts at these positions. Where there is no number for a motor, that is a
  /// fault, and none has a torque.
  void make(std::span<const double> joints, std::span<const double> efforts, FaultSink& faults) noexcept;
  void let_go() noexcept { torque_.fill(0); }
  /// What holds motors together, of those in `followed`. Behind `make`.
  void add(std::span<const double> more_nm, IndexSet followed) noexcept;
  /// As another loop left it.
  void take_over(std::size_t actuator, double torque_nm) noexcept { torque_[actuator] = torque_nm; }

  /// Some motor's cogging is known.
  [[nodiscard]] bool know_cogging() const noexcept { return have_cogging_ != 0; }
  /// Takes the motors' own torque away, where they will be when this cycle's torque acts: from the `measured` shaft
  /// angles on as fast as those that are wanted go. Measured, because cogging pulls from place to place like a spring,
  /// by a negative stiffness half of the way, which a loop may be too soft to hold. Of the motors in `followed`.
  void cancel_cogging(std::span<const double> measured, std::span<const double> wanted, IndexSet followed) noexcept;

  [[nodiscard]] double operator[](std::size_t actuator) const noexcept { return torque_[actuator]; }
  [[nodiscard]] std::span<const double> all() const noexcept { return {torque_.data(), actuators_.size()}; }

 private:
  const ActuatorMap& map_;
  std::span<const ServoActuator> actuators_;
  double period_s_;
  std::vector<CoggingMap> cogging_;  ///< of each motor
  IndexSet have_cogging_ = 0;
  IndexSet followed_ = 0;  ///< in the last cycle
  std::array<double, kMaxJoints> torque_{}, wanted_before_{};
};

}  // namespace rmac
