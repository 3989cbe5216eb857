#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

#include "gateway/servo/snapshot.hpp"
#include "gateway/state/cycle_sample.hpp"

namespace rmac::gateway {

/// The samples of the last cycles. The servo thread adds one a cycle over the oldest, and never waits; any other thread
/// reads them by the cycle's number. So one ring serves whoever follows the machine and whoever looks back at it.
class CycleHistory {
 public:
  /// Of `capacity` cycles. All of its memory is touched here.
  explicit CycleHistory(std::size_t capacity) : slots_(std::max<std::size_t>(capacity, 1)) {}

  /// Servo thread, real-time safe. Cycles count from 1 without gaps.
  void add(const CycleSample& sample) noexcept {
    slot(sample.cycle).write(sample);
    newest_.store(sample.cycle, std::memory_order_release);
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }
  /// The last cycle's number; 0 before the first.
  [[nodiscard]] std::int64_t newest() const noexcept { return newest_.load(std::memory_order_acquire); }
  /// The first cycle's number that is still there.
  [[nodiscard]] std::int64_t oldest() const noexcept {
    return std::max<std::int64_t>(1, newest() - static_cast<std::int64_t>(capacity()) + 1);
  }
  /// False when that cycle is not there any more, or not yet.
  [[nodiscard]] bool read(std::int64_t cycle, CycleSample& sample) const noexcept {
    sample = slot(cycle).read();
    return sample.cycle == cycle && cycle > 0;
  }
  /// The last cycle's sample; an empty one before the first.
  [[nodiscard]] CycleSample latest() const noexcept {
    CycleSample sample;
    std::int64_t cycle = 0;
    do {
      cycle = newest();
    } while (!read(cycle, sample) && cycle != 0);
    return cycle == 0 ? CycleSample{} : sample;
  }

  /// Says that cycles from this one on are still wanted. In virtual time the machine waits rather than to overwrite
  /// them; in real pace it does not.
  void want_from(std::int64_t cycle) noexcept { wanted_from_.store(cycle, std::memory_order_release); }
  /// Whether the next cycle would overwrite one that is wanted.
  [[nodiscard]] bool would_overwrite() const noexcept {
    return newest() + 1 - static_cast<std::int64_t>(capacity()) >= wanted_from_.load(std::memory_order_acquire);
  }
  static constexpr std::int64_t kNothing = std::numeric_limits<std::int64_t>::max();

  /// Forgets everything, for another servo thread that counts from 1 again. While none runs.
  void restart() noexcept {
    for (auto& slot : slots_) slot.write(CycleSample{});
    newest_.store(0, std::memory_order_release);
  }

 private:
  using Slot = SequenceLocked<CycleSample>;
  [[nodiscard]] std::size_t index(std::int64_t cycle) const noexcept {
    return static_cast<std::size_t>(cycle) % slots_.size();
  }
  [[nodiscard]] Slot& slot(std::int64_t cycle) noexcept { return slots_[index(cycle)]; }
  [[nodiscard]] const Slot& slot(std::int64_t cycle) const noexcept { return slots_[index(cycle)]; }

  std::vector<Slot> slots_;
  std::atomic<std::int64_t> newest_{0};
  std::atomic<std::int64_t> wanted_from_{kNothing};
};

}  // namespace rmac::gateway
