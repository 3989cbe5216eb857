#include "gateway/simulators/vdrive/axis/power_states.hpp"

#include <array>

namespace rmac::vdrive {
namespace {

// The controlword's bits (CiA 402-2, 8.4.1)
constexpr unsigned kSwitchOn = 0x01;
constexpr unsigned kEnableVoltage = 0x02;
constexpr unsigned kQuickStop = 0x04;  // asked for by 0
constexpr unsigned kEnableOperation = 0x08;
constexpr unsigned kFaultReset = 0x80;

constexpr int kStaysInQuickStop = 5;  // option codes from here on

}  // namespace

Braking braking_of(int code) {
  if (code >= kStaysInQuickStop) code -= 4;
  constexpr std::array kBraking{Braking::Coast, Braking::SlowDown, Braking::QuickStop, Braking::Torque,
                                Braking::Torque};
  return kBraking.at(static_cast<std::size_t>(code));
}

void PowerStates::enter(State state) {
  state_ = state;
  after_stop_.reset();
  enables_ = false;
}

void PowerStates::enter_quick_stop(const OptionCodes& options) {
  enter(options.quick_stop == 0 ? SwitchOnDisabled : QuickStop);
  braking_ = braking_of(options.quick_stop);
}

void PowerStates::leave_operation(State to, bool slow_down) {
  if (!slow_down) return enter(to);
  braking_ = Braking::SlowDown;
  after_stop_ = to;
}

bool PowerStates::control(std::uint16_t word, const OptionCodes& options) {
  const bool reset = (word & kFaultReset) != 0;
  const bool reset_rose = reset && !reset_before_;
  reset_before_ = reset;
  if (state_ == NotReady || state_ == FaultReaction) return false;
  if (state_ == Fault) {
    if (reset_rose) enter(SwitchOnDisabled);  // 15
    return reset_rose;
  }
  if ((word & kEnableVoltage) == 0) {  // disable voltage: 7, 9, 10, 12
    enter(SwitchOnDisabled);
  } else if ((word & kQuickStop) == 0) {  // quick stop: 7, 10, 11
    if (state_ == OperationEnabled) {
      enter_quick_stop(options);
    } else if (state_ != QuickStop) {
      enter(SwitchOnDisabled);
    }
  } else if ((word & kSwitchOn) == 0) {  // shutdown: 2, 6, 8
    if (state_ == OperationEnabled) {
      leave_operation(ReadyToSwitchOn, options.shutdown == 1);
    } else if (state_ != QuickStop) {
      enter(ReadyToSwitchOn);
    }
  } else if ((word & kEnableOperation) == 0) {  // switch on: 3; disable operation: 5
    if (state_ == ReadyToSwitchOn) enter(SwitchedOn);
    if (state_ == OperationEnabled) leave_operation(SwitchedOn, options.disable_operation == 1);
  } else {  // enable operation: 4, 16; from Ready to Switch On it is switch on with enable operation: 3 and 4
    const bool may_return = state_ == QuickStop && options.quick_stop >= kStaysInQuickStop;
    if (state_ == ReadyToSwitchOn) {
      enter(SwitchedOn);
      enables_ = true;
    } else if (state_ == SwitchedOn || state_ == OperationEnabled || may_return) {
      enter(OperationEnabled);
    }
  }
  return false;
}

void PowerStates::raise_fault(const OptionCodes& options) {
  if (state_ == Fault || state_ == FaultReaction) return;
  // Where there is no power there is nothing to react with.
  const bool moving = powered();
  enter(FaultReaction);
  braking_ = moving ? braking_of(options.fault_reaction) : Braking::Coast;
}

void PowerStates::abort_connection(int option, const OptionCodes& options) {
  // Where there is no power there is nothing that the loss could endanger: a reset leaves such a drive without fault.
  if (option == 1 && powered()) return raise_fault(options);
  if (option == 2 && state_ != Fault && state_ != FaultReaction && state_ != NotReady) enter(SwitchOnDisabled);
  if (option == 3 && state_ == OperationEnabled) enter_quick_stop(options);
}

void PowerStates::proceed(bool standing, const OptionCodes& options) {
  const bool at_rest = standing || braking_ == Braking::Coast;
  if (state_ == NotReady) {
    enter(SwitchOnDisabled);  // 1; 0 is power on
  } else if (state_ == SwitchedOn && enables_) {
    enter(OperationEnabled);
  } else if (state_ == OperationEnabled && after_stop_ && standing) {
    enter(*after_stop_);
  } else if (state_ == QuickStop && at_rest && options.quick_stop < kStaysInQuickStop) {
    enter(SwitchOnDisabled);  // 12
  } else if (state_ == FaultReaction && at_rest) {
    enter(Fault);  // 14
  }
}

std::uint16_t PowerStates::statusword() const {
  // By state, with bit 4 (voltage) where there is some and bit 9 (remote): CiA 402-2, tables 30 and 31.
  constexpr std::array<std::uint16_t, 8> kWords{0x0200, 0x0240, 0x0231, 0x0233, 0x0237, 0x0217, 0x021F, 0x0218};
  return kWords.at(state_);
}

const char* to_string(PowerStates::State state) {
  constexpr std::array kNames{"not-ready",         "switch-on-disabled", "ready-to-switch-on", "switched-on",
                              "operation-enabled", "quick-stop",         "fault-reaction",     "fault"};
  return kNames.at(state);
}

}  // namespace rmac::vdrive
