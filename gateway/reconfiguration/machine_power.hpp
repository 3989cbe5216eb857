#pragma once

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/reconfiguration/servo_requests.hpp"

namespace rmac::gateway {

/// The power of the drives of the mechanism in force: on, off, and out of a fault. Each call returns when the drives
/// are there, or have not come there in time. Gateway thread.
class MachinePower {
 public:
  MachinePower(MotionSupervisor& supervisor, ServoRequests& servo) : supervisor_(supervisor), servo_(servo) {}

  /// Every joint is held by its loop afterwards. `mechanism` names what is at fault where it is not.
  [[nodiscard]] Expected<> on(const Mechanism* mechanism);
  /// Drives have some cycles to hear of it before their bus may stop.
  void off();
  /// Resets the drives' faults. The error says which cause is still there.
  [[nodiscard]] Expected<> clear_fault(const Mechanism* mechanism);

 private:
  MotionSupervisor& supervisor_;
  ServoRequests& servo_;
};

}  // namespace rmac::gateway
