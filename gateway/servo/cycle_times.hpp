#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace rmac::gateway {

/// How often times of each length occurred: bins of one ns up to 16 ns, then sixteen to an octave, so that a bin's
/// upper end is at most 1/16 above any time in it. What is longer than eight seconds counts as that.
struct TimeCounts {
  static constexpr int kOctave = 16;
  static constexpr std::size_t kBins = std::size_t{30} * kOctave;

  [[nodiscard]] static constexpr std::size_t bin_of(std::int64_t ns) noexcept {
    if (ns < kOctave) return ns < 0 ? 0 : static_cast<std::size_t>(ns);
    const int octave = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(ns))) - 5;
    const std::size_t bin = static_cast<std::size_t>(octave) * kOctave + static_cast<std::size_t>(ns >> octave);
    return bin < kBins ? bin : kBins - 1;
  }
  /// The largest time that a bin counts, ns.
  [[nodiscard]] static constexpr std::int64_t end_of(std::size_t bin) noexcept {
    if (bin < kOctave) return static_cast<std::int64_t>(bin);
    const std::size_t octave = bin / kOctave - 1;
    return (static_cast<std::int64_t>(bin - octave * kOctave + 1) << octave) - 1;
  }

  /// That which so large a part of all times does not exceed, to within its bin, ns; 0 when there were none.
  [[nodiscard]] std::int64_t quantile_ns(double part) const noexcept;

  std::array<std::uint64_t, kBins> bins{};
  std::uint64_t count = 0;
  std::int64_t largest_ns = 0;
};

/// Counts times on one thread, real-time safe; any thread reads, without holding the other up: a reading may be in the
/// midst of a cycle.
class TimeHistogram {
 public:
  void add(std::int64_t ns) noexcept {
    auto& bin = bins_[TimeCounts::bin_of(ns)];
    bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (ns > largest_ns_.load(std::memory_order_relaxed)) largest_ns_.store(ns, std::memory_order_relaxed);
  }
  void clear() noexcept;
  [[nodiscard]] TimeCounts read() const noexcept;

 private:
  std::array<std::atomic<std::uint64_t>, TimeCounts::kBins> bins_{};
  std::atomic<std::int64_t> largest_ns_{0};
};

/// Where the servo thread's time goes, cycle by cycle, since the mechanism in force was put in. In virtual time nothing
/// is waited for, and there are no wake-ups.
struct CycleTimes {
  TimeHistogram wake_up;  ///< from when a cycle was due until it began
  TimeHistogram compute;  ///< of the cycle, without the bus
  TimeHistogram bus;      ///< in its exchange with drives and I/O

  void clear() noexcept {
    wake_up.clear();
    compute.clear();
    bus.clear();
  }
};

}  // namespace rmac::gateway
