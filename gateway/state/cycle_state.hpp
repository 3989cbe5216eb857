#pragma once

#include <cstdint>
#include <string>

namespace rmac::gateway {

/// What the machine's cycle does.
enum class CycleState : std::uint8_t { Idle, Running, Holding, Stopping, Faulted, EmergencyStop };

[[nodiscard]] const char* to_string(CycleState state) noexcept;
/// Left by a reset alone.
[[nodiscard]] constexpr bool is_faulted(CycleState state) noexcept {
  return state == CycleState::Faulted || state == CycleState::EmergencyStop;
}

/// Moves that were queued and needed no curve of their own.
struct Cleaned {
  std::uint64_t without_motion = 0;  ///< they end where they begin
  std::uint64_t merged = 0;          ///< lines much shorter than the tolerance, which became part of the next one
};

/// The cycle as the controller has it now; a sample is some cycles behind.
struct CycleNow {
  CycleState state = CycleState::Idle;
  const char* mode = "";  ///< Appendix IV's name of the mode of the cycle that is started; empty when none is
  double override_percent = 100;
  /// What a cycle that runs waits for: moves, override, check, tool, spindle, dwell or input; empty: it does not.
  const char* waits_for = "";
  std::string held_by{};        ///< the operator who holds the machine; empty: none does
  bool optional_stops = false;  ///< hold the program
  std::string stop_prompt{};    ///< what a person is to see to before the program goes on; empty: nothing
  Cleaned cleaned{};
};

}  // namespace rmac::gateway
