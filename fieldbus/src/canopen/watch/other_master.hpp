#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>

#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::fieldbus::canopen {

/// What shows a second master on a bus that has one: its SYNCs, and its NMT commands. The servo thread notes it, and
/// others ask for the command. Locks nothing.
class OtherMaster {
 public:
  using Time = std::chrono::nanoseconds;

  struct Command {
    std::uint8_t command = 0;
    std::uint8_t node = 0;  ///< 0: all
  };

  void forget() noexcept {
    syncs_ = 0;
    command_.store(0, std::memory_order_relaxed);
  }
  /// A SYNC came; one that strays is none's.
  void sync(Time now) noexcept {
    syncs_ = now - last_sync_ > kForgetAfter ? 1 : syncs_ + 1;
    last_sync_ = now;
  }
  [[nodiscard]] bool sends_sync(Time now) const noexcept {
    return syncs_ >= kEvidence && now - last_sync_ <= kForgetAfter;
  }
  /// An NMT frame came, `since_start`.
  void command(const CanFrame& frame, Time since_start) noexcept {
    if (frame.size < 2 || frame.data[0] == static_cast<std::uint8_t>(NmtCommand::Start)) return;
    commanded_ns_.store(since_start.count(), std::memory_order_relaxed);
    command_.store(kAny | std::uint32_t{frame.data[0]} << 8U | frame.data[1], std::memory_order_release);
  }
  /// The latest command that took `node` out of operation, within the last second. Any thread.
  [[nodiscard]] std::optional<Command> commanded(std::uint8_t node, Time since_start) const noexcept {
    const std::uint32_t told = command_.load(std::memory_order_acquire);
    const auto to = static_cast<std::uint8_t>(told);
    const Time when(commanded_ns_.load(std::memory_order_relaxed));
    if (told == 0 || (to != 0 && to != node) || since_start - when > kForgetAfter) return {};
    return Command{static_cast<std::uint8_t>(told >> 8U), to};
  }

 private:
  static constexpr int kEvidence = 3;
  static constexpr Time kForgetAfter = std::chrono::seconds(1);
  static constexpr std::uint32_t kAny = 1U << 16U;

  int syncs_ = 0;
  Time last_sync_{0};
  std::atomic<std::uint32_t> command_{0};
  std::atomic<std::int64_t> commanded_ns_{0};
};

}  // namespace rmac::fieldbus::canopen
