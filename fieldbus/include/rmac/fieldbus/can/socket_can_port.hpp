#pragma once

#include <memory>
#include <span>
#include <string>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus {

/// A raw CAN socket on one interface. The kernel drops what no filter asks for, so that foreign traffic costs nothing.
class SocketCanPort final : public CanPort {
 public:
  /// Opens the interface for the identifiers in `wanted`, or for all when it is empty. The error says what is wrong
  /// with the interface and how to mend it. `queue_frames`: how many frames one burst of the caller holds; a transmit
  /// queue that is shorter is refused, because it would overflow. Off the cycle.
  [[nodiscard]] static Expected<std::unique_ptr<SocketCanPort>> open(const std::string& interface,
                                                                     std::span<const std::uint16_t> wanted,
                                                                     std::size_t queue_frames);
  ~SocketCanPort() override;
  SocketCanPort(const SocketCanPort&) = delete;
  SocketCanPort& operator=(const SocketCanPort&) = delete;

  bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(CanFrame& frame) noexcept override;
  void wait(std::chrono::nanoseconds at_most) noexcept override;
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept override;
  [[nodiscard]] CanHealth health() const noexcept override { return health_; }
  [[nodiscard]] CanController controller() const noexcept override { return read_can_controller(interface_index_); }

 private:
  explicit SocketCanPort(int socket) noexcept : socket_(socket) {}
  void take_failure(int error) noexcept;

  int socket_;
  int interface_index_ = 0;
  CanHealth health_;
};

}  // namespace rmac::fieldbus
