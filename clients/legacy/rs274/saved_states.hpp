#pragma once

#include <cstddef>
#include <map>
#include <optional>

#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::rs274 {

/// M70 to M73: what holds is saved and restored, once in the program and in each sub that runs. A level is how many of
/// those run within each other.
class SavedStates {
 public:
  explicit SavedStates(gcode::Interpreter& interpreter) : interpreter_(interpreter) {}

  /// Throws a Refusal for an M72 with nothing saved.
  void act(const gcode::After& code, std::size_t level);
  /// The sub of that level ends at `place`: what its M73 saved holds again.
  void leave(std::size_t level, std::size_t place);

 private:
  struct Saved {
    gcode::State state;
    bool until_end = false;  ///< by M73
  };

  gcode::Interpreter& interpreter_;
  std::map<std::size_t, Saved> saved_;  ///< by level
};

}  // namespace rmac::rs274
