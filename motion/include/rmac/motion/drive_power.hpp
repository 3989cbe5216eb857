#pragma once

#include <cstdint>

namespace rmac {

/// States of the power drive system (CiA 402 / IEC 61800-7-201, figure "state machine").
enum class DriveState : std::uint8_t {
  NotReadyToSwitchOn,
  SwitchOnDisabled,
  ReadyToSwitchOn,
  SwitchedOn,
  OperationEnabled,
  QuickStopActive,
  FaultReactionActive,
  Fault,
};

/// What the master wants of a drive.
enum class DriveWish : std::uint8_t {
  Off,          ///< no torque, brake on
  Operational,  ///< follows its setpoints
  QuickStop,    ///< brakes by itself, at the rate set in the drive
};

/// Bits of the controlword (6040h) that the master and a drive agree on.
namespace controlword {
inline constexpr std::uint16_t kSwitchOn = 1U << 0;
inline constexpr std::uint16_t kEnableVoltage = 1U << 1;
inline constexpr std::uint16_t kNoQuickStop = 1U << 2;  ///< zero asks for a quick stop
inline constexpr std::uint16_t kEnableOperation = 1U << 3;
inline constexpr std::uint16_t kStartHoming = 1U << 4;  ///< in homing mode: its rise starts, its fall ends
inline constexpr std::uint16_t kFaultReset = 1U << 7;   ///< acts on its rising edge
}  // namespace controlword

/// Bits of the statusword (6041h) in homing mode (CiA 402-2, 13.4.2).
namespace statusword {
inline constexpr std::uint16_t kTargetReached = 1U << 10;  ///< it is at rest
inline constexpr std::uint16_t kHomingAttained = 1U << 12;
inline constexpr std::uint16_t kHomingError = 1U << 13;
}  // namespace statusword

/// Decodes a statusword (6041h), bits 0 to 3, 5 and 6. A pattern that the standard leaves undefined is taken for
/// NotReadyToSwitchOn, which waits. Real-time safe.
[[nodiscard]] DriveState drive_state(std::uint16_t statusword) noexcept;

/// The controlword that takes a drive one transition nearer to `wish`. `reset_fault` asks for a fault reset:
/// `previous`, the controlword sent last, tells whether the reset bit must fall first so that it can rise. Real-time
/// safe.
[[nodiscard]] std::uint16_t next_controlword(std::uint16_t statusword, DriveWish wish, bool reset_fault,
                                             std::uint16_t previous) noexcept;

/// The name of the state that a statusword tells, as clients and people read it: "operation enabled"; "unknown" where
/// the standard leaves the pattern undefined.
[[nodiscard]] const char* drive_state_text(std::uint16_t statusword) noexcept;

}  // namespace rmac
