#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::sdk {

/// A program that was set aside in the midst of it.
struct ParkedProgram {
  std::string mechanism;
  std::size_t moves = 0;     ///< to do, tool changes and what is between moves too, what was begun included
  std::int64_t move_id = 0;  ///< of that one
  double s_mm = 0;           ///< how far along it the tool was
  ToolPose place;            ///< where it goes on, in the part frame that is in force
  double off_mm = 0;         ///< how far the tool stands from there
};

/// Sets a held program aside and takes it up again. Gateway thread only.
class Parking {
 public:
  virtual ~Parking() = default;

  /// Sets what is held aside, from its place on: the queue is empty then, and the machine free to be jogged, measured
  /// with, or loaded in another role. Spindle and coolant go off.
  virtual Expected<> park() = 0;
  /// Queues it again, in the part frame and with the tool in force now, and holds it: a resume switches spindle and
  /// coolant on again and goes on. The tool must stand within a millimetre of the place; the last bit is made straight.
  /// On a refusal the program stays parked.
  virtual Expected<> take_up() = 0;
  virtual Expected<> drop() = 0;
  [[nodiscard]] virtual std::optional<ParkedProgram> parked() const = 0;
};

}  // namespace rmac::sdk
