#include "rmac/motion/drive_power.hpp"

namespace rmac {

DriveState drive_state(std::uint16_t statusword) noexcept {
  switch (statusword & 0x4F) {
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
      return DriveState::NotReadyToSwitchOn;
  }
}

namespace {

using namespace controlword;
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

const char* to_string(DriveState state) noexcept {
  switch (state) {
    case DriveState::NotReadyToSwitchOn:
      return "Not Ready To Switch On";
    case DriveState::SwitchOnDisabled:
      return "Switch On Disabled";
    case DriveState::ReadyToSwitchOn:
      return "Ready To Switch On";
    case DriveState::SwitchedOn:
      return "Switched On";
    case DriveState::OperationEnabled:
      return "Operation Enabled";
    case DriveState::QuickStopActive:
      return "Quick Stop Active";
    case DriveState::FaultReactionActive:
      return "Fault Reaction Active";
    case DriveState::Fault:
      return "Fault";
  }
  return "unknown";
}

}  // namespace rmac
