#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "gateway/servo/servo_link.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Asks the servo thread to change what it runs, and waits for its answers. One thread at a time, never the servo
/// thread.
class ServoRequests {
 public:
  /// The servo thread answers within cycles, drives within the loop's own time-out; beyond this something hangs.
  static constexpr std::chrono::seconds kPatience{10};

  /// `meanwhile` is called again and again while an answer is not there. It takes over samples, because in virtual time
  /// a full ring would keep the servo thread from answering, and lets time pass.
  ServoRequests(ServoLink& link, std::function<void()> meanwhile, std::chrono::nanoseconds patience = kPatience)
      : link_(link), meanwhile_(std::move(meanwhile)), patience_(patience) {}

  [[nodiscard]] ServoStatus status() const noexcept { return link_.status.read(); }
  /// Waits until `reached` is true; false when patience ended first.
  [[nodiscard]] bool wait_for(const std::function<bool()>& reached) const;
  /// Waits until the loop's status satisfies `reached`; false when patience ended first.
  [[nodiscard]] bool wait_for_status(const std::function<bool(const ServoStatus&)>& reached) const;

  /// Another mechanism for the servo thread, or none, known as `generation` from then on; refused while it moves.
  [[nodiscard]] Expected<> swap(Mechanism* next, std::uint64_t generation);
  /// Hands a request over; its `result` is the servo thread's. The error says that nobody answers.
  [[nodiscard]] Expected<> ask(SwapRequest& request);

 private:
  ServoLink& link_;
  std::function<void()> meanwhile_;
  std::chrono::nanoseconds patience_;
};

}  // namespace rmac::gateway
