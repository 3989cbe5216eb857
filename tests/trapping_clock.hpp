#pragma once

#include <atomic>
#include <memory>

#include "gateway/servo/clock.hpp"
#include "gateway/verifier/trap.hpp"

namespace rmac::gateway {

/// Another clock, with the trap set from the moment a cycle is due until the thread asks for the next one.
/// `after_cycle` is called then, on that thread, with the trap not set.
class TrappingClock final : public Clock {
 public:
  explicit TrappingClock(std::shared_ptr<Clock> clock, void (*after_cycle)() = nullptr)
      : clock_(std::move(clock)), after_cycle_(after_cycle) {}

  std::uint64_t wait_for_cycle() noexcept override {
    if (cycles_ == 0) catches_system_calls_ = verifier::prepare_trap();
    verifier::disarm_trap();
    if (after_cycle_ != nullptr) after_cycle_();
    const std::uint64_t missed = clock_->wait_for_cycle();
    cycles_ = cycles_ + 1;
    verifier::arm_trap();
    return missed;
  }
  std::int64_t late_ns() const noexcept override { return clock_->late_ns(); }
  void restart() noexcept override { clock_->restart(); }

  [[nodiscard]] std::int64_t cycles() const { return cycles_; }
  [[nodiscard]] bool catches_system_calls() const { return catches_system_calls_; }

 private:
  std::shared_ptr<Clock> clock_;
  void (*after_cycle_)();
  std::atomic<std::int64_t> cycles_{0};
  std::atomic<bool> catches_system_calls_{false};
};

}  // namespace rmac::gateway
