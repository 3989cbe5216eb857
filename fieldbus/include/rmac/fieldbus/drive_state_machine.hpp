#pragma once

#include <cstdint>

namespace rmac::fieldbus {

/// The power state machine inside a CiA 402 drive: controlwords in, statusword out. For drives that have none of their
/// own: simulated ones, and those behind Modbus. Real-time safe.
class DriveStateMachine {
 public:
  /// Takes one controlword: one transition at most.
  void step(std::uint16_t controlword) noexcept;
  /// Goes to Fault and stays there until a fault reset finds the cause gone.
  void trip(std::uint16_t error_code) noexcept;

  [[nodiscard]] std::uint16_t statusword() const noexcept;
  [[nodiscard]] std::uint16_t error_code() const noexcept { return error_code_; }
  [[nodiscard]] bool operational() const noexcept { return state_ == State::OperationEnabled; }
  [[nodiscard]] bool quick_stopping() const noexcept { return state_ == State::QuickStopActive; }

 private:
  enum class State : std::uint8_t {
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStopActive,
    Fault
  };
  State state_ = State::SwitchOnDisabled;
  std::uint16_t previous_ = 0;
  std::uint16_t error_code_ = 0;
};

}  // namespace rmac::fieldbus
