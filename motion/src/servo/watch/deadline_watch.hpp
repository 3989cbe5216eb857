#pragma once

#include <cstdint>

#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// Counts deadlines that passed, second by second. Real-time safe.
class DeadlineWatch {
 public:
  /// `most`: in a second; 0: not watched.
  DeadlineWatch(int most, double period_s) noexcept : most_(most), period_s_(period_s) {}

  /// One cycle, and the deadlines missed before it. `driving`: they count.
  void step(std::uint64_t missed, bool driving, FaultSink& faults) noexcept {
    if (most_ <= 0) return;
    if (static_cast<double>(++cycles_) * period_s_ > 1) missed_ = 0, cycles_ = 0;
    missed_ += missed;
    if (!driving || missed_ <= static_cast<std::uint64_t>(most_)) return;
    faults.raise({ServoFault::Kind::CyclesLost, ServoFault::Part::Clock, 0, static_cast<double>(missed_),
                  static_cast<double>(most_)});
  }

 private:
  int most_;
  double period_s_;
  std::uint64_t missed_ = 0;  ///< within the second that runs
  std::int64_t cycles_ = 0;   ///< of that second
};

}  // namespace rmac
