#include "gateway/servo/clock.hpp"

#include <cerrno>
#include <cmath>
#include <ctime>

namespace rmac::gateway {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

class MonotonicClock final : public Clock {
 public:
  explicit MonotonicClock(double period_s)
      : period_ns_(std::llround(period_s * static_cast<double>(kNanosecondsPerSecond))) {
    restart();
  }

  std::uint64_t wait_for_cycle() noexcept override {
    late_ns_ = now_ns() - due_ns_;
    std::uint64_t missed = 0;
    if (late_ns_ > 0) {
      missed = static_cast<std::uint64_t>(late_ns_ / period_ns_) + 1;
      due_ns_ += static_cast<std::int64_t>(missed - 1) * period_ns_;
    } else {
      const timespec due{due_ns_ / kNanosecondsPerSecond, due_ns_ % kNanosecondsPerSecond};
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
      }
      late_ns_ = now_ns() - due_ns_;
    }
    due_ns_ += period_ns_;
    return missed;
  }

  std::int64_t late_ns() const noexcept override { return late_ns_; }
  void restart() noexcept override { due_ns_ = now_ns() + period_ns_; }

 private:
  static std::int64_t now_ns() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
  }

  std::int64_t period_ns_;
  std::int64_t due_ns_ = 0;
  std::int64_t late_ns_ = 0;
};

}  // namespace

std::shared_ptr<Clock> make_monotonic_clock(double period_s) {
  return std::make_shared<MonotonicClock>(period_s);
}

}  // namespace rmac::gateway
