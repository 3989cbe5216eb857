#pragma once

#include <cstddef>
#include <cstdint>

#include "rmac/motion/error.hpp"

namespace rmac {

/// Port: up to 64 digital inputs and outputs. Bit numbers are given names in `device.json`.
class DigitalIoInterface {
 public:
  virtual ~DigitalIoInterface() = default;
  /// Claims the lines; the error names the line that is missing. Off the cycle.
  [[nodiscard]] virtual Expected<> start() = 0;
  /// Puts outputs into their safe state. Off the cycle; cannot fail.
  virtual void stop() noexcept = 0;
  /// One cycle: writes `outputs`, reads `inputs`. False when the device failed. Real-time safe.
  [[nodiscard]] virtual bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept = 0;
  /// How long before the last exchange the input `bit`, which is on, came on, in s; 0 where the device stamps no edges.
  /// Real-time safe.
  [[nodiscard]] virtual double on_for_s(std::size_t /*bit*/) const noexcept { return 0; }
  /// Bits that something is connected to: a name for another one is a mistake.
  [[nodiscard]] virtual std::uint64_t input_bits() const noexcept { return ~std::uint64_t{0}; }
  [[nodiscard]] virtual std::uint64_t output_bits() const noexcept { return ~std::uint64_t{0}; }
};

}  // namespace rmac
