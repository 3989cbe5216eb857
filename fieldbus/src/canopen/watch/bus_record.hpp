#pragma once

#include "canopen/watch/recent.hpp"
#include "rmac/fieldbus/bus_report.hpp"
#include "rmac/fieldbus/canopen/canopen_interface.hpp"

namespace rmac::fieldbus::canopen {

/// What a bus went through since it was started: the servo thread notes it each cycle, others read it. Locks nothing.
class BusRecord {
 public:
  void start(std::chrono::nanoseconds now) noexcept {
    started_ = now;
    note({}, {}, now);
  }
  /// How long it has run; of the thread of the cycle.
  [[nodiscard]] std::chrono::nanoseconds since_start(std::chrono::nanoseconds now) const noexcept {
    return now - started_;
  }
  void note(const CanopenCounters& counters, const CanHealth& health, std::chrono::nanoseconds now) noexcept;

  /// How long it had run in its latest cycle. Any thread.
  [[nodiscard]] std::chrono::nanoseconds run() const noexcept { return std::chrono::nanoseconds(run_ns_.get()); }
  /// All but its name and nodes. Any thread.
  [[nodiscard]] BusReport report() const;

 private:
  std::chrono::nanoseconds started_{0};
  Tally run_ns_, cycles_, unsent_, short_answers_;
  Tally sent_, received_, queue_full_, send_failures_, overflowed_, error_frames_, warnings_, passives_, bus_offs_;
  Tally bus_off_, link_down_;  ///< 0 or 1
};

}  // namespace rmac::fieldbus::canopen
