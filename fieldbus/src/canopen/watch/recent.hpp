#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace rmac::fieldbus::canopen {

/// A number that one thread raises and others read. Locks nothing.
class Tally {
 public:
  void add(std::uint64_t amount = 1) noexcept { value_.store(get() + amount, std::memory_order_relaxed); }
  void set(std::uint64_t value) noexcept { value_.store(value, std::memory_order_relaxed); }
  void raise_to(std::uint64_t value) noexcept {
    if (value > get()) set(value);
  }
  [[nodiscard]] std::uint64_t get() const noexcept { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// The latest words that one thread notes, for others to read. Each word is whole, for it is one atomic; a reader may
/// miss the oldest ones, where newer ones came meanwhile. Locks and allocates nothing on the thread that notes.
class Recent {
 public:
  static constexpr std::size_t kKept = 8;

  void note(std::uint64_t word) noexcept {
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    words_[count % kKept].store(word, std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_release);
  }
  void forget() noexcept { count_.store(0, std::memory_order_release); }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// Newest first.
  [[nodiscard]] std::vector<std::uint64_t> latest() const {
    std::vector<std::uint64_t> words;
    const std::uint64_t count = this->count();
    for (std::uint64_t i = 0; i < count && i < kKept; ++i) {
      words.push_back(words_[(count - 1 - i) % kKept].load(std::memory_order_relaxed));
    }
    return words;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kKept> words_{};
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace rmac::fieldbus::canopen
