#pragma once

#include <atomic>

#include "canopen/watch/boot_problem.hpp"

namespace rmac::fieldbus::canopen {

/// Why a node is away: the servo thread notes it, others ask. Locks nothing.
class NodeTrouble {
 public:
  void note(const BootProblem& problem) noexcept {
    object_.store((std::uint32_t{problem.object.index} << 8U) | problem.object.sub, std::memory_order_relaxed);
    expected_.store(problem.expected, std::memory_order_relaxed);
    found_.store(problem.found, std::memory_order_relaxed);
    writing_.store(problem.writing, std::memory_order_relaxed);
    needed_.store(problem.needed, std::memory_order_relaxed);
    waited_.store(problem.waited, std::memory_order_relaxed);
    drive_.store(problem.drive, std::memory_order_relaxed);
    kind_.store(problem.kind, std::memory_order_release);
  }
  void forget() noexcept { kind_.store(BootProblem::Kind::None, std::memory_order_release); }
  [[nodiscard]] BootProblem problem() const noexcept {
    const BootProblem::Kind kind = kind_.load(std::memory_order_acquire);
    const std::uint32_t object = object_.load(std::memory_order_relaxed);
    return {.kind = kind,
            .object = {static_cast<std::uint16_t>(object >> 8), static_cast<std::uint8_t>(object)},
            .expected = expected_.load(std::memory_order_relaxed),
            .found = found_.load(std::memory_order_relaxed),
            .writing = writing_.load(std::memory_order_relaxed),
            .needed = needed_.load(std::memory_order_relaxed),
            .waited = waited_.load(std::memory_order_relaxed),
            .drive = drive_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<BootProblem::Kind> kind_{BootProblem::Kind::None};
  std::atomic<std::uint32_t> object_{0}, expected_{0}, found_{0};
  std::atomic<bool> writing_{false};
  std::atomic<const char*> needed_{""};
  std::atomic<std::chrono::milliseconds> waited_{std::chrono::milliseconds(0)};
  std::atomic<const DriveDescription*> drive_{nullptr};
};

}  // namespace rmac::fieldbus::canopen
