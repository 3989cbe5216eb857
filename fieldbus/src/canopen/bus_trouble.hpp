#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// Why a bus failed in a cycle: the servo thread notes it, others ask.
class BusTrouble {
 public:
  /// Notes a cycle that failed; `unsent` frames were not taken since the bus was started, and another node sends SYNC,
  /// too. Real-time safe.
  void note(const CanHealth& health, std::uint64_t unsent, bool other_sync = false) noexcept {
    unsent_.store(unsent, std::memory_order_relaxed);
    kind_.store(health.link_down ? Kind::LinkDown
                : health.bus_off ? Kind::BusOff
                : other_sync     ? Kind::OtherSync
                                 : Kind::Unsent,
                std::memory_order_relaxed);
  }
  /// What is wrong with the latest cycle that failed, and what to do.
  [[nodiscard]] std::string text(const std::string& interface) const;

 private:
  enum class Kind : std::uint8_t { LinkDown, BusOff, OtherSync, Unsent };

  std::atomic<Kind> kind_{Kind::Unsent};
  std::atomic<std::uint64_t> unsent_{0};
};

}  // namespace rmac::fieldbus::canopen
