#pragma once

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

enum class CycleMode { Manual = 0, Automatic = 1 };

/// Starts, stops, holds and resumes what is queued. Gateway thread only.
class CycleControl {
 public:
  virtual ~CycleControl() = default;

  virtual Expected<> start(CycleMode mode) = 0;
  virtual Expected<> stop() = 0;
  virtual Expected<> hold() = 0;
  virtual Expected<> resume() = 0;
  /// Runs back along up to `distance_mm` of the path of what is held, then holds again; `resume` runs forward from
  /// there, at any time. The way it will go, in mm.
  virtual Expected<double> retrace(double distance_mm) = 0;
  /// Stops as fast as the limits allow and empties the queue.
  virtual Expected<> stop_now() = 0;
  /// Leaves `Faulted` or `EmergencyStop` once the cause is gone.
  virtual Expected<> reset() = 0;
  /// True from a start to the end of the cycle, a hold included.
  [[nodiscard]] virtual bool started() const = 0;
  /// Scales the feed of all that runs, from now on; 0 waits.
  virtual Expected<> set_feed_override(double percent) = 0;
};

}  // namespace rmac::sdk
