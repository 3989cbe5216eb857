#pragma once

#include <cstdint>

namespace rmac::gateway {

/// What the machine's cycle does.
enum class CycleState : std::uint8_t { Idle, Running, Holding, Stopping, Faulted, EmergencyStop };

[[nodiscard]] const char* to_string(CycleState state) noexcept;
/// Left by a reset alone.
[[nodiscard]] constexpr bool is_faulted(CycleState state) noexcept {
  return state == CycleState::Faulted || state == CycleState::EmergencyStop;
}

/// The cycle as the controller has it now; a sample is some cycles behind.
struct CycleNow {
  CycleState state = CycleState::Idle;
  const char* mode = "";  ///< Appendix IV's name of the mode of the cycle that is started; empty when none is
  double override_percent = 100;
};

}  // namespace rmac::gateway
