#pragma once

#include "clients/legacy/apt/statements/arguments.hpp"
#include "clients/legacy/program/machine_switches.hpp"

namespace rmac::apt {

/// SPINDL and COOLNT.
class Switches {
 public:
  explicit Switches(legacy::Writer& writer) : machine_(writer) {}

  /// SPINDL/n,CLW with RPM and in any order; ON and OFF.
  void set_spindle(Arguments& arguments);
  /// COOLNT/ON, FLOOD, MIST, OFF.
  void set_coolant(Arguments& arguments);
  void tool_was_changed() noexcept { machine_.tool_was_changed(); }
  /// The end of the program.
  void off() { machine_.off(); }

 private:
  legacy::MachineSwitches machine_;
  int way_ = 0;  ///< that was said last; 1: clockwise
};

}  // namespace rmac::apt
