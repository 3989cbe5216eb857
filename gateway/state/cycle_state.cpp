#include "gateway/state/cycle_state.hpp"

namespace rmac::gateway {

const char* to_string(CycleState state) noexcept {
  switch (state) {
    case CycleState::Idle:
      return "Idle";
    case CycleState::Running:
      return "Running";
    case CycleState::Holding:
      return "Holding";
    case CycleState::Stopping:
      return "Stopping";
    case CycleState::Faulted:
      return "Faulted";
    case CycleState::EmergencyStop:
      return "EmergencyStop";
  }
  return "Unknown";
}

}  // namespace rmac::gateway
