#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rmac/motion/follower/horizon.hpp"

namespace rmac {

/// Bounded single-producer single-consumer queue of trivially copyable values. Lock-free, wait-free, no allocation.
template <typename T, std::size_t kCapacity>
class SpscRing {
 public:
  [[nodiscard]] bool push(const T& value) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == kCapacity) return false;
    slots_[tail % kCapacity] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  [[nodiscard]] bool pop(T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    value = slots_[head % kCapacity];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  [[nodiscard]] std::size_t size() const noexcept {
    return tail_.load(std::memory_order_acquire) - head_.load(std::memory_order_acquire);
  }
  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return kCapacity; }

 private:
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  alignas(64) std::array<T, kCapacity> slots_{};
};

struct Plan;

/// Plans from the planner to the servo loop, and back when the servo loop is through with them: the planner alone
/// allocates and frees.
struct PlanChannel {
  SpscRing<const Plan*, 16> published;
  SpscRing<const Plan*, 64> retired;
  /// Id of the first plan by which the motion ends as `PathCommand::Stop` asked, as by all behind it; 0 while none was
  /// asked for, or is found.
  std::atomic<std::uint64_t> stopping{0};
  HorizonNews horizon;
};

}  // namespace rmac
