#pragma once

#include <string>
#include <vector>

namespace rmac::gateway {

struct RealTimeWish {
  int priority = 80;  ///< SCHED_FIFO, 1 to 99
  int cpu = -1;       ///< -1: any
  bool lock_memory = true;
};

/// Locks the process' memory and has all of the calling thread's stack there beforehand, where that is wished, and
/// gives the calling thread its priority and CPU. What was not granted, each with how to grant it; empty when all was.
/// See docs/real-time.md.
[[nodiscard]] std::vector<std::string> enter_real_time(const RealTimeWish& wish);

}  // namespace rmac::gateway
