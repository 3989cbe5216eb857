#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace rmac::gateway {

/// What paces the servo thread. Called by that thread alone; real-time safe.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Returns when the next cycle is due. The cycles whose time had passed already: 0 when in time.
  [[nodiscard]] virtual std::uint64_t wait_for_cycle() noexcept = 0;
  /// How long after it was due the last cycle began, ns.
  [[nodiscard]] virtual std::int64_t late_ns() const noexcept = 0;
  /// The next cycle is due one period from now, whatever was due before.
  virtual void restart() noexcept = 0;
};

/// CLOCK_MONOTONIC, slept on with absolute times, so that a late cycle does not move those after it.
[[nodiscard]] std::shared_ptr<Clock> make_monotonic_clock(double period_s);

}  // namespace rmac::gateway
