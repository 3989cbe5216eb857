#pragma once

#include <time.h>

#include <chrono>

namespace rmac::gateway {

/// What a CPU clock shows: of a thread (`pthread_getcpuclockid`), or of the process.
[[nodiscard]] inline std::chrono::nanoseconds cpu_time(clockid_t clock) noexcept {
  timespec now{};
  (void)clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace rmac::gateway
