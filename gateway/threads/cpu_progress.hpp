#pragma once

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <cstdint>

#include "gateway/threads/cpu_time.hpp"

namespace rmac::gateway {

/// Whether a thread that should get on does: it is stuck when it has used so much of its own CPU time since it last
/// made progress. A computer that is busy with something else makes no difference. Any thread may say that progress was
/// made; one asks.
class CpuProgress {
 public:
  /// Of the calling thread, which must outlive this.
  explicit CpuProgress(std::chrono::nanoseconds patience) noexcept : patience_(patience) {
    (void)pthread_getcpuclockid(pthread_self(), &clock_);
    used_ = cpu_time(clock_);
  }

  void made() noexcept { made_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] bool stuck() noexcept {
    const std::chrono::nanoseconds now = cpu_time(clock_);
    if (const std::uint64_t made = made_.load(std::memory_order_relaxed); made != seen_) {
      seen_ = made;
      used_ = now;
    }
    return now - used_ > patience_;
  }

 private:
  std::chrono::nanoseconds patience_;
  clockid_t clock_{};
  std::atomic<std::uint64_t> made_{0};
  std::uint64_t seen_ = 0;
  std::chrono::nanoseconds used_{};
};

}  // namespace rmac::gateway
