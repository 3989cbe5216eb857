#pragma once

#include <memory>

#include "gateway/cycle/machine_cycle.hpp"

namespace rmac::gateway {

/// What the path is held against before it is planned. Gateway thread.
class Guarding {
 public:
  explicit Guarding(MachineCycle& cycle) : cycle_(cycle) {}

  /// From now on it is this, or nothing. Refused, with the name of the function that wanted it, while something moves
  /// or is queued: what was checked, and by what, is not to be mixed.
  [[nodiscard]] Expected<> put_in(const char* function, std::shared_ptr<ClearWay> way);
  /// The same, where the mechanism in force was changed: nothing is queued then.
  void replace(std::shared_ptr<ClearWay> way);
  /// What is in the spindle; null: nobody knows.
  void set_tool(std::shared_ptr<const Tool> tool);
  [[nodiscard]] bool on();
  void tell(Event::Kind kind, const std::string& message);

 private:
  MachineCycle& cycle_;
};

}  // namespace rmac::gateway
