#pragma once

#include <span>
#include <vector>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/cycles_beyond.hpp"

namespace rmac {

/// Watches the torques that the motors' drives measure. Real-time safe but for its making.
class TorqueWatch {
 public:
  /// `actuators` must outlive it.
  explicit TorqueWatch(std::span<const ServoActuator> actuators) : actuators_(actuators), beyond_(actuators.size()) {}

  /// One cycle under power: what the drives told.
  void step(FaultSink& faults) noexcept;
  /// There is no power.
  void rest() noexcept;

 private:
  std::span<const ServoActuator> actuators_;
  std::vector<CyclesBeyond> beyond_;
};

}  // namespace rmac
