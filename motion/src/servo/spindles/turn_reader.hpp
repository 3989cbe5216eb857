#pragma once

#include <cstdint>

#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac {

/// How fast a spindle turns and how that changes, from the encoder of its drive. Real-time safe.
class TurnReader {
 public:
  TurnReader(const DriveScale& scale, double period_s) noexcept : scale_(scale), period_s_(period_s) {}

  /// The words of this cycle. A drive that does not answer leaves what was, and the speed begins anew.
  void read(const DriveFeedback& words) noexcept;
  /// Its speed and the change of it are those of the last readings.
  [[nodiscard]] bool settled() const noexcept { return history_ == 2; }
  [[nodiscard]] double rpm() const noexcept { return rpm_; }
  [[nodiscard]] double rpm_per_s() const noexcept { return rpm_per_s_; }
  [[nodiscard]] std::int64_t counts() const noexcept { return counts_; }  ///< since the first reading

 private:
  DriveScale scale_;
  double period_s_;
  bool seen_ = false;
  std::int32_t last_counts_ = 0;
  std::int64_t counts_ = 0;
  std::uint8_t history_ = 0;  ///< readings one after the other before the next, 2 at most
  double step_ = 0;           ///< turns in the last cycle
  double rpm_ = 0, rpm_per_s_ = 0;
};

}  // namespace rmac
