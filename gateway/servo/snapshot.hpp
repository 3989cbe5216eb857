#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace rmac::gateway {

/// A value that one thread replaces and any other reads whole: a sequence lock (H.-J. Boehm, "Can seqlocks get along
/// with programming language memory models?", MSPC 2012). The writer never waits. A reader retries while a write is
/// under way, so it must not be the servo thread.
template <typename T>
class SequenceLocked {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  SequenceLocked() { write(T{}); }

  void write(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    // Release on each word instead of a fence: free on x86, and thread sanitizers understand it.
    for (std::size_t i = 0; i < kWords; ++i) slots_[i].store(words[i], std::memory_order_release);
    sequence_.store(sequence + 2, std::memory_order_release);
  }

  [[nodiscard]] T read() const noexcept {
    Words words{};
    for (;;) {
      const std::uint64_t before = sequence_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) words[i] = slots_[i].load(std::memory_order_acquire);
      const std::uint64_t after = sequence_.load(std::memory_order_relaxed);
      if (before == after && before % 2 == 0) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return value;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;
  std::atomic<std::uint64_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> slots_{};
};

/// The latest of the values that one thread writes, for one other thread to take: a triple buffer. Neither side ever
/// waits, so the servo thread may be either.
template <typename T>
class LatestValue {
 public:
  /// Several writers must take turns under a lock of theirs.
  void write(const T& value) noexcept {
    slots_[back_] = value;
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }
  /// The latest value; stays valid until the next call.
  [[nodiscard]] const T& read() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_];
  }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kIndex = 3;
  std::array<T, 3> slots_{};
  std::uint8_t back_ = 0;
  std::uint8_t front_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace rmac::gateway
