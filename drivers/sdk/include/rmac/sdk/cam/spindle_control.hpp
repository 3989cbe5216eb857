#pragma once

#include <string>

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// Spindles, numbered from 0, in rpm, the coolant, and whatever else hangs at an output. Gateway thread only.
class SpindleControl {
 public:
  virtual ~SpindleControl() = default;

  /// The sign is the sense of turning; 0 stops. Feed waits until the speed is reached.
  virtual Expected<> set_rpm(int spindle, double rpm) = 0;
  /// Measured.
  [[nodiscard]] virtual Expected<double> rpm(int spindle) const = 0;
  /// Largest speed that `set_rpm` takes; at most the mechanism's own.
  virtual Expected<> set_max_rpm(int spindle, double rpm) = 0;
  [[nodiscard]] virtual Expected<double> max_rpm(int spindle) const = 0;
  /// Switches the output that is named Coolant.
  virtual Expected<> set_coolant(bool on) = 0;
  /// Switches the output of this name.
  virtual Expected<> set_output(const std::string& name, bool on) = 0;
};

}  // namespace rmac::sdk
