#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "rmac/fieldbus/can/can_controller.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::fieldbus {

/// A frame with an 11-bit identifier: all that CANopen uses (CiA 301, 6.2).
struct CanFrame {
  std::uint16_t id = 0;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 8> data{};
  bool remote = false;                ///< it asks for the data (RTR): sent only, for node guarding
  std::chrono::nanoseconds stamp{0};  ///< of a received frame: when the kernel took it, CLOCK_REALTIME

  [[nodiscard]] bool operator==(const CanFrame& other) const noexcept {
    return id == other.id && size == other.size && data == other.data && remote == other.remote;
  }
};

/// What a port went through since it was opened, and how its bus is now.
struct CanHealth {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t queue_full = 0;     ///< frames not sent because the transmit queue was full (ENOBUFS); never retried
  std::uint64_t send_failures = 0;  ///< frames not sent for another reason
  std::uint64_t overflowed = 0;     ///< frames lost because nobody fetched them in time (SO_RXQ_OVFL)
  std::uint64_t error_frames = 0;   ///< reports of the controller: warnings, protocol errors, bus-off
  std::uint64_t warnings = 0;       ///< times that the controller reported its warning level
  std::uint64_t passives = 0;       ///< times that it became error-passive
  std::uint64_t bus_offs = 0;
  bool bus_off = false;    ///< the controller left the bus
  bool link_down = false;  ///< the interface is down

  [[nodiscard]] bool usable() const noexcept { return !bus_off && !link_down; }
};

/// One end of a CAN bus: a raw socket, or a wire inside the process where the machine has no CAN. One thread at a time.
/// All but `wait` and
/// `controller` are real-time safe.
class CanPort {
 public:
  virtual ~CanPort() = default;
  /// Queues a frame. False when it could not be: counted in `health`, and lost.
  virtual bool send(const CanFrame& frame) noexcept = 0;
  /// Fetches the next frame that waits. False when there is none.
  [[nodiscard]] virtual bool receive(CanFrame& frame) noexcept = 0;
  /// Sleeps until a frame waits or the time is up. Off the cycle.
  virtual void wait(std::chrono::nanoseconds at_most) noexcept = 0;
  /// The clock that this bus lives by; monotonic.
  [[nodiscard]] virtual std::chrono::nanoseconds now() const noexcept = 0;
  [[nodiscard]] virtual CanHealth health() const noexcept = 0;
  /// How the controller is now; unknown where there is none, as on a wire inside the process. Any thread; off the
  /// cycle.
  [[nodiscard]] virtual CanController controller() const noexcept { return {}; }
};

}  // namespace rmac::fieldbus
