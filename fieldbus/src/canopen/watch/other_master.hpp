#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
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
    for (auto& told : told_) told.command.store(0, std::memory_order_relaxed);
  }
  /// A SYNC came; one that strays is none's.
  void sync(Time now) noexcept {
    syncs_ = now - last_sync_ > kForgetAfter ? 1 : std::min(syncs_ + 1, kEvidence);
    last_sync_ = now;
  }
  [[nodiscard]] bool sends_sync(Time now) const noexcept {
    return syncs_ >= kEvidence && now - last_sync_ <= kForgetAfter;
  }
  /// An NMT frame came, `since_start`.
  void command(const CanFrame& frame, Time since_start) noexcept {
    if (frame.size < 2 || frame.data[0] == static_cast<std::uint8_t>(NmtCommand::Start)) return;
    const std::uint8_t to = frame.data[1];
    for (std::size_t node = to == 0 ? 1 : to; node < (to == 0 ? told_.size() : to + std::size_t{1}); ++node) {
      if (node >= told_.size()) return;
      told_[node].when_ns.store(since_start.count(), std::memory_order_relaxed);
      told_[node].command.store(kAny | std::uint32_t{frame.data[0]} << 8U | to, std::memory_order_release);
    }
  }
  /// The latest command that took `node` out of operation, within the last second. Any thread.
  [[nodiscard]] std::optional<Command> commanded(std::uint8_t node, Time since_start) const noexcept {
    if (node >= told_.size()) return {};
    const std::uint32_t told = told_[node].command.load(std::memory_order_acquire);
    const Time when(told_[node].when_ns.load(std::memory_order_relaxed));
    if (told == 0 || since_start - when > kForgetAfter) return {};
    return Command{static_cast<std::uint8_t>(told >> 8U), static_cast<std::uint8_t>(told)};
  }

 private:
  static constexpr int kEvidence = 3;
  static constexpr Time kForgetAfter = std::chrono::seconds(1);
  static constexpr std::uint32_t kAny = 1U << 16U;

  int syncs_ = 0;
  Time last_sync_{0};
  struct Told {
    std::atomic<std::uint32_t> command{0};
    std::atomic<std::int64_t> when_ns{0};
  };
  std::array<Told, 128> told_{};  ///< by node id
};

}  // namespace rmac::fieldbus::canopen
