#pragma once

#include <cstdint>
#include <optional>

namespace rmac::fieldbus {

/// What an encoder makes of an angle.
struct EncoderParameters {
  // 17 bits, of the Sigma-II series; which encoder a machine has is a choice of its builder, so: assumed.
  double counts_per_revolution = 131072;
  double noise_counts = 0;          ///< standard deviation
  double interpolation_counts = 0;  ///< amplitude of the error within a signal period
  double signal_periods = 2048;     ///< assumed: sine periods of the disc, a turn
  bool at_load = false;             ///< it looks at the load, and not at the motor
  std::uint64_t seed = 1;           ///< of the noise
};

/// Counts, with the errors of an encoder and the faults that tests give it. Real-time safe.
class SimulatedEncoder {
 public:
  explicit SimulatedEncoder(const EncoderParameters& parameters) noexcept
      : parameters_(parameters), random_(parameters.seed) {}

  /// The next cycle: noise of its own.
  void sample() noexcept;
  /// What it reads at an angle in this cycle; wraps.
  [[nodiscard]] std::int32_t counts(double angle_rad) const noexcept;
  /// What is there to read: the truth, whatever shifts and freezes the reading.
  [[nodiscard]] std::int32_t counts_without_error(double angle_rad) const noexcept;
  /// The reading moves without the shaft, as when a reference is lost.
  void shift(std::int32_t counts) noexcept { offset_ += counts; }
  /// The reading stays what it is at `angle_rad`, whatever the shaft does; and goes on.
  void freeze(bool frozen, double angle_rad) noexcept;

 private:
  EncoderParameters parameters_;
  std::int64_t offset_ = 0;
  double noise_ = 0;  ///< counts, in this cycle
  std::uint64_t random_;
  std::optional<std::int32_t> frozen_;
};

}  // namespace rmac::fieldbus
