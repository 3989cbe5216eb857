#pragma once

#include <cstdint>
#include <optional>

namespace rmac::vdrive {

/// How a drive comes to rest.
enum class Braking : std::uint8_t {
  Coast,      ///< power off at once; the holding brake closes
  SlowDown,   ///< on the profile's deceleration (6084h)
  QuickStop,  ///< on the quick stop's deceleration (6085h)
  Torque,     ///< with all torque that the motor has
};

/// Option codes: what a drive does on its way out of Operation Enabled (CiA 402-2, 605Ah to 605Eh).
struct OptionCodes {
  int quick_stop = 2;
  int shutdown = 0;
  int disable_operation = 1;
  int fault_reaction = 2;
};

/// By codes 1 to 4 of the quick stop, and 5 to 8 alike, but staying there; those of halt and fault reaction are the
/// same.
[[nodiscard]] Braking braking_of(int code);

/// The power state machine of CiA 402-2, figure 3, with all its transitions. Written from the standard's tables and not
/// from the master's code.
class PowerStates {
 public:
  enum State : std::uint8_t {
    NotReady,
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStop,
    FaultReaction,
    Fault
  };

  /// Acts on a controlword. True when it reset a fault.
  bool control(std::uint16_t word, const OptionCodes& options);
  void raise_fault(const OptionCodes& options);
  /// What losing its master makes a drive do (6007h): 1 fault, 2 disable voltage, 3 quick stop.
  void abort_connection(int option, const OptionCodes& options);
  /// What goes on by itself: transitions 0, 1, 4, 12, 14, and the end of a slowing down.
  void proceed(bool standing, const OptionCodes& options);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool operating() const { return state_ == OperationEnabled && !after_stop_; }
  /// Power on the motor: the brake is open.
  [[nodiscard]] bool powered() const {
    return state_ == OperationEnabled ||
           ((state_ == QuickStop || state_ == FaultReaction) && braking_ != Braking::Coast);
  }
  /// How to brake, while powered and not operating.
  [[nodiscard]] Braking braking() const { return braking_; }
  /// Bits 0 to 6 and 9 (remote).
  [[nodiscard]] std::uint16_t statusword() const;

 private:
  void enter(State state);
  void enter_quick_stop(const OptionCodes& options);
  void leave_operation(State to, bool slow_down);

  State state_ = NotReady;
  Braking braking_ = Braking::Coast;
  std::optional<State> after_stop_;  ///< where a slowing down in Operation Enabled leads (transitions 5 and 8)
  bool enables_ = false;             ///< on through Switched On into Operation Enabled (transitions 3 and 4 in one)
  bool reset_before_ = false;
};

[[nodiscard]] const char* to_string(PowerStates::State state);

}  // namespace rmac::vdrive
