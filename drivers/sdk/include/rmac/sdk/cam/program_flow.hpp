#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// A call that a program makes in its turn: a spindle's speed, or an output by its name.
struct SpindleCall {
  int spindle = 0;
  double rpm = 0;
};
struct OutputCall {
  std::string name;
  bool on = false;
};
using CallInTurn = std::variant<SpindleCall, OutputCall>;

/// What a program does between its moves, each in its turn: queued behind the moves before it, with an id that comes
/// back in events as a move's does. The path comes to rest there, but for outputs. A full queue is CommandQueueFull, as
/// of a move. Gateway thread only.
class ProgramFlow {
 public:
  virtual ~ProgramFlow() = default;

  /// The longest dwell, and the longest time that an input is waited for.
  static constexpr double kLongest_s = 3600;

  /// Rests for so long.
  virtual Expected<> dwell(std::int64_t id, double time_s) = 0;
  /// Holds the program, for a person to resume; an optional stop only where those are switched on when its turn comes.
  /// `message` is for that person.
  virtual Expected<> stop(std::int64_t id, bool optional, const std::string& message) = 0;
  /// Waits until the machine's input of this name is on, or off. When it is not within `timeout_s`, the program is
  /// held, and waits once more when it is resumed.
  virtual Expected<> await_input(std::int64_t id, const std::string& name, bool on, double timeout_s) = 0;
  /// Makes calls, in their order; what follows waits for the spindles' speeds.
  virtual Expected<> in_turn(std::int64_t id, const std::vector<CallInTurn>& calls) = 0;

  /// The switch for optional stops; off at first.
  virtual void set_optional_stops(bool on) = 0;
  [[nodiscard]] virtual bool optional_stops() const = 0;
};

}  // namespace rmac::sdk
