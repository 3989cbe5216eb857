#pragma once

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// Feed, accelerations and tolerances of path moves that are queued from now on, in the wire's units: mm, mm/min,
/// mm/s², degrees. What bounds the mechanism itself can only be tightened. Gateway thread only.
class PathSettings {
 public:
  virtual ~PathSettings() = default;

  virtual Expected<> set_feedrate(double mm_min) = 0;
  /// Actual speed of the tool tip from measured joints, mm/min.
  [[nodiscard]] virtual double feedrate() const = 0;
  virtual Expected<> set_max_feedrate(double mm_min) = 0;
  [[nodiscard]] virtual double max_feedrate() const = 0;
  /// Path acceleration while the feed rises; 0: the joints alone bound it.
  virtual Expected<> set_accel_rise(double mm_s2) = 0;
  [[nodiscard]] virtual double accel_rise() const = 0;
  /// Likewise while the feed falls.
  virtual Expected<> set_accel_fall(double mm_s2) = 0;
  [[nodiscard]] virtual double accel_fall() const = 0;
  /// How far the path may be from what was programmed; 0: an exact stop wherever it is not smooth.
  virtual Expected<> set_tolerance(double mm) = 0;
  [[nodiscard]] virtual double tolerance() const = 0;
  /// How far the tool axis may be from what was programmed; 0: not at all.
  virtual Expected<> set_orientation_tolerance(double degrees) = 0;
  [[nodiscard]] virtual double orientation_tolerance() const = 0;
};

}  // namespace rmac::sdk
