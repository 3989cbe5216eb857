#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>

#include "gateway/simulators/vmodbus/device.hpp"

namespace rmac::vmodbus {

using Clock = std::chrono::steady_clock;
using Devices = std::map<int, std::unique_ptr<Device>>;  ///< by slave number

/// How frames stand on a line: with a head and a length (Modbus Messaging on TCP/IP V1.0b, 3.1), or with a check sum
/// and silence between them (Modbus over Serial Line V1.02, 2.5.1).
enum class Framing : std::uint8_t { Tcp, Rtu };

/// The slave's end of one line: bytes in, and out when they are due. It owns its descriptor.
class Line {
 public:
  Line(int descriptor, Framing framing, Devices& devices)
      : descriptor_(descriptor), framing_(framing), devices_(devices) {}
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Takes what has come; false when the other end is gone.
  [[nodiscard]] bool receive();
  /// Sends what is due, and looks for frames that ended in silence; false when the other end is gone.
  [[nodiscard]] bool proceed();

 private:
  struct Out {
    Clock::time_point due;
    Bytes bytes;
  };
  [[nodiscard]] bool take_tcp();
  void take_rtu(bool silence);
  void handle(std::span<const std::uint8_t> head, std::uint8_t slave, std::span<const std::uint8_t> request);
  void answer(Device& device, std::span<const std::uint8_t> head, std::uint8_t slave,
              std::span<const std::uint8_t> request);
  [[nodiscard]] Bytes frame(std::span<const std::uint8_t> head, std::uint8_t slave, const Bytes& answer) const;

  int descriptor_;
  Framing framing_;
  Devices& devices_;
  Bytes kept_;
  Clock::time_point came_{};
  std::deque<Out> out_;
  std::uint32_t noise_ = 1;
};

/// CRC-16 of a frame (Modbus over Serial Line V1.02, 6.2.2); it travels low byte first.
[[nodiscard]] std::uint16_t check_sum(std::span<const std::uint8_t> bytes);

}  // namespace rmac::vmodbus
