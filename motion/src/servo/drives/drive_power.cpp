#include "rmac/motion/drive_power.hpp"

#include <optional>

namespace rmac {

namespace {

/// Nothing for a pattern that the standard leaves undefined (CiA 402-2, table 29: bits 0 to 3, 5 and 6).
std::optional<DriveState> defined_state(std::uint16_t statusword) noexcept {
  switch (statusword & 0x4F) {
    case 0x00:
      return DriveState::NotReadyToSwitchOn;
    case 0x40:
      return DriveState::SwitchOnDisabled;
    case 0x0F:
      return DriveState::FaultReactionActive;
    case 0x08:
      return DriveState::Fault;
    default:
      break;
  }
  switch (statusword & 0x6F) {
    case 0x21:
      return DriveState::ReadyToSwitchOn;
    case 0x23:
      return DriveState::SwitchedOn;
    case 0x27:
      return DriveState::OperationEnabled;
    case 0x07:
      return DriveState::QuickStopActive;
    default:
      return {};
  }
}

}  // namespace

DriveState drive_state(std::uint16_t statusword) noexcept {
  return defined_state(statusword).value_or(DriveState::NotReadyToSwitchOn);
}

namespace {

using controlword::kEnableOperation;
using controlword::kEnableVoltage;
using controlword::kFaultReset;
using controlword::kNoQuickStop;
using controlword::kSwitchOn;
constexpr std::uint16_t kDisableVoltage = 0;
constexpr std::uint16_t kQuickStop = kEnableVoltage;
constexpr std::uint16_t kShutdown = kEnableVoltage | kNoQuickStop;
constexpr std::uint16_t kSwitchOnCommand = kShutdown | kSwitchOn;
constexpr std::uint16_t kEnable = kSwitchOnCommand | kEnableOperation;

std::uint16_t towards_operational(DriveState state) noexcept {
  switch (state) {
    case DriveState::SwitchOnDisabled:
      return kShutdown;
    case DriveState::ReadyToSwitchOn:
      return kSwitchOnCommand;
    case DriveState::SwitchedOn:
    case DriveState::OperationEnabled:
      return kEnable;
    // Straight back from a quick stop (transition 16) is optional in the standard; by way of Switch On Disabled works
    // with every drive.
    case DriveState::QuickStopActive:
    case DriveState::NotReadyToSwitchOn:
    case DriveState::FaultReactionActive:
    case DriveState::Fault:
      return kDisableVoltage;
  }
  return kDisableVoltage;
}

}  // namespace

std::uint16_t next_controlword(std::uint16_t statusword, DriveWish wish, bool reset_fault,
                               std::uint16_t previous) noexcept {
  const DriveState state = drive_state(statusword);
  if (state == DriveState::Fault) {
    return reset_fault && (previous & kFaultReset) == 0 ? kFaultReset : kDisableVoltage;
  }
  switch (wish) {
    case DriveWish::Off:
      return kDisableVoltage;
    case DriveWish::Operational:
      return towards_operational(state);
    case DriveWish::QuickStop:
      return kQuickStop;
  }
  return kDisableVoltage;
}

const char* drive_state_text(std::uint16_t statusword) noexcept {
  const auto state = defined_state(statusword);
  if (!state) return "unknown";
  switch (*state) {
    case DriveState::NotReadyToSwitchOn:
      return "not ready to switch on";
    case DriveState::SwitchOnDisabled:
      return "switch on disabled";
    case DriveState::ReadyToSwitchOn:
      return "ready to switch on";
    case DriveState::SwitchedOn:
      return "switched on";
    case DriveState::OperationEnabled:
      return "operation enabled";
    case DriveState::QuickStopActive:
      return "quick stop active";
    case DriveState::FaultReactionActive:
      return "fault reaction active";
    case DriveState::Fault:
      return "fault";
  }
  return "unknown";
}

}  // namespace rmac
