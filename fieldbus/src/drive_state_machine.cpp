#include "rmac/fieldbus/drive_state_machine.hpp"

#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus {

void DriveStateMachine::step(std::uint16_t word) noexcept {
  using namespace controlword;
  const bool reset_rose = (word & kFaultReset) != 0 && (previous_ & kFaultReset) == 0;
  previous_ = word;
  if (state_ == State::Fault) {
    if (reset_rose) {
      state_ = State::SwitchOnDisabled;
      error_code_ = 0;
    }
    return;
  }
  if ((word & kEnableVoltage) == 0) {
    state_ = State::SwitchOnDisabled;
    return;
  }
  if ((word & kNoQuickStop) == 0) {
    state_ = state_ == State::OperationEnabled || state_ == State::QuickStopActive ? State::QuickStopActive
                                                                                   : State::SwitchOnDisabled;
    return;
  }
  // What is left is shutdown, switch on, or enable operation; one transition a cycle.
  const bool switch_on = (word & kSwitchOn) != 0;
  const bool enable = switch_on && (word & kEnableOperation) != 0;
  switch (state_) {
    case State::SwitchOnDisabled:
      if (!switch_on) state_ = State::ReadyToSwitchOn;
      break;
    case State::ReadyToSwitchOn:
      if (switch_on) state_ = State::SwitchedOn;
      break;
    case State::SwitchedOn:
    case State::OperationEnabled:
      state_ = enable ? State::OperationEnabled : switch_on ? State::SwitchedOn : State::ReadyToSwitchOn;
      break;
    case State::QuickStopActive:  // left by disabling the voltage only
    case State::Fault:
      break;
  }
}

void DriveStateMachine::trip(std::uint16_t error_code) noexcept {
  state_ = State::Fault;
  error_code_ = error_code;
}

std::uint16_t DriveStateMachine::statusword() const noexcept {
  constexpr std::uint16_t kVoltageEnabled = 1U << 4;
  constexpr std::uint16_t kRemote = 1U << 9;
  constexpr std::uint16_t kCommon = kVoltageEnabled | kRemote;
  switch (state_) {
    case State::SwitchOnDisabled:
      return kCommon | 0x40;
    case State::ReadyToSwitchOn:
      return kCommon | 0x21;
    case State::SwitchedOn:
      return kCommon | 0x23;
    case State::OperationEnabled:
      return kCommon | 0x27;
    case State::QuickStopActive:
      return kCommon | 0x07;
    case State::Fault:
      return kCommon | 0x08;
  }
  return kCommon;
}

}  // namespace rmac::fieldbus
