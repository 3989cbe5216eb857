#pragma once

#include "gateway/cycle/machine_cycle.hpp"

namespace rmac::gateway {

/// The operator who holds the machine, by a hold or by an override of 0; null: none does.
[[nodiscard]] OperatorRef holder(MachineCycle& cycle) REQUIRES(cycle.lock);

/// What a person does to the motion of a program: its feed, the way back, and what an operator holds. `by` is the
/// operator who commands it, or null. Gateway thread.
class Operating {
 public:
  explicit Operating(MachineCycle& cycle) : cycle_(cycle) {}

  /// Refuses what would have a joint or a spindle move, where an operator holds the machine.
  [[nodiscard]] Expected<> require_free(const char* what);
  [[nodiscard]] Expected<> set_override(double percent, const OperatorRef& by);
  /// Runs back along up to `distance_mm` of the path of what is held. The way it will go, in mm.
  [[nodiscard]] Expected<double> retrace(double distance_mm, const OperatorRef& by);
  /// The switch on the panel, see `ProgramTurn`.
  void set_optional_stops(bool on);
  /// What an operator holds, by a hold or by an override of 0, is the program's to resume; nothing moves.
  void let_go();
  /// The same, unless the operator who holds it is there: then an error that names them. True when there was something.
  [[nodiscard]] Expected<bool> take_over();

 private:
  MachineCycle& cycle_;
};

}  // namespace rmac::gateway
