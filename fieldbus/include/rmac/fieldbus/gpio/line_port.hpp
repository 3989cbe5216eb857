#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::gpio {

/// On the monotonic clock of the kernel, which stamps edges with it.
using Time = std::chrono::nanoseconds;

/// What the controller does to an input's level when nobody drives it.
enum class Bias : std::uint8_t { AsIs, PullUp, PullDown, None };

/// A line, and what its level means.
struct LineSpec {
  std::string chip;  ///< name (gpiochip0), label, number or path
  std::string name;  ///< of the line, or # and its number on the chip
  Bias bias = Bias::AsIs;
  bool inverted = false;  ///< low is active
};

/// A line changed its level.
struct Edge {
  std::size_t line = 0;  ///< of the inputs
  bool high = false;     ///< afterwards
  Time at{};
};

/// Seam: the lines of GPIO chips as the adapter needs them. Levels are physical.
class LinePort {
 public:
  virtual ~LinePort() = default;
  /// Claims all lines, outputs at the levels that are inactive. The error names the chip or line that is missing or
  /// taken. Off the cycle.
  [[nodiscard]] virtual Expected<> open(std::span<const LineSpec> inputs, std::span<const LineSpec> outputs) = 0;
  /// Gives all lines back. Off the cycle.
  virtual void close() noexcept = 0;

  // Real-time safe; false when the device failed.
  /// Levels of all inputs now, 0 or 1.
  [[nodiscard]] virtual bool read_levels(std::span<std::uint8_t> high) noexcept = 0;
  /// Edges since the last call, those of each line in order. The span is good until the next call.
  [[nodiscard]] virtual bool read_edges(std::span<const Edge>& edges) noexcept = 0;
  [[nodiscard]] virtual bool write(std::size_t output, bool high) noexcept = 0;
  [[nodiscard]] virtual Time now() noexcept = 0;
};

/// Lines of the kernel's GPIO chips, through libgpiod.
[[nodiscard]] std::unique_ptr<LinePort> make_kernel_lines();

}  // namespace rmac::fieldbus::gpio
