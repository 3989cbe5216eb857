#pragma once

#include "rmac/fieldbus/modbus/spindle_interface.hpp"
#include "unit/fieldbus/modbus/register_bank.hpp"

namespace rmac::fieldbus::modbus {

inline constexpr auto kHolding = Table::HoldingRegisters;
inline constexpr std::uint16_t kCommand = 0x10, kSpeedCommand = 0x11, kReset = 0x12;
inline constexpr std::uint16_t kStatus = 0x20, kActual = 0x21, kTaken = 0x22, kFault = 0x23;
inline constexpr std::uint16_t kStop = 1, kForward = 2, kBackward = 3;

/// A drive with all that a map can have: 0.1 Hz, a status of bit 0 runs, bit 1 backward, bit 2 tripped.
inline SpindleMap spindle_map() {
  SpindleMap made;
  made.name = "a drive";
  made.most_per_read = 8;
  made.speed_command = {{kHolding, kSpeedCommand}, 10};
  made.speed_read_back = Place{kHolding, kTaken};
  made.speed = {{kHolding, kActual}, 10};
  made.running = Condition{{kHolding, kStatus, 16, false, false, 1}, {1}};
  made.backward = Condition{{kHolding, kStatus, 16, false, false, 2}, {2}};
  made.tripped = Condition{{kHolding, kStatus, 16, false, false, 4}, {4}};
  made.fault_code = Place{kHolding, kFault};
  made.fault_texts = {{7, "over-voltage"}};
  made.forward_run = {{kHolding, kCommand, kForward}};
  made.backward_run = {{kHolding, kCommand, kBackward}};
  made.stop = {{kHolding, kCommand, kStop}};
  made.reset_fault = {{kHolding, kReset, 1}};
  return made;
}

/// When a test gives up that cycles until something is reached: the line and the test had a thousand turns each, or a
/// minute has passed.
class Patience {
 public:
  explicit Patience(const SpindleInterface& spindle) : spindle_(spindle), begun_(spindle.counters().rounds) {}
  [[nodiscard]] bool ends() {
    constexpr std::uint64_t kTurns = 1000;
    return (++turns_ > kTurns && spindle_.counters().rounds > begun_ + kTurns) || Clock::now() > give_up_;
  }

 private:
  const SpindleInterface& spindle_;
  std::uint64_t begun_, turns_ = 0;
  Clock::time_point give_up_ = Clock::now() + std::chrono::minutes(1);
};

/// What the drive does with what is written to it: it turns at once.
inline void turn(RegisterBank& bank, Table, std::uint16_t address, std::uint16_t value) {
  if (address == kReset) {
    bank.set(kHolding, kStatus, 0);
    bank.set(kHolding, kFault, 0);
  }
  if (address == kSpeedCommand) bank.set(kHolding, kTaken, value);
  const std::uint16_t command = bank.get(kHolding, kCommand);
  const bool tripped = (bank.get(kHolding, kStatus) & 4U) != 0;
  const bool runs = (command == kForward || command == kBackward) && !tripped;
  const unsigned status = (runs ? 1U : 0U) | (runs && command == kBackward ? 2U : 0U) | (tripped ? 4U : 0U);
  bank.set(kHolding, kStatus, static_cast<std::uint16_t>(status));
  bank.set(kHolding, kActual, runs ? bank.get(kHolding, kSpeedCommand) : 0);
}

}  // namespace rmac::fieldbus::modbus
