#pragma once

#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac {

/// The touch probe of one drive, which latches its position at a contact: armed until it has latched, and again when
/// the probe has let go. Real-time safe.
class ProbeLatch {
 public:
  /// `edge`: that of the drive's input at which the contact closes.
  explicit ProbeLatch(TouchProbeEdge edge) noexcept : edge_(edge) {}

  /// The drive's words of this cycle; `touching` as the probe was in the cycle before. True in the cycle in which an
  /// edge is seen to have latched.
  bool read(const DriveFeedback& words, bool touching) noexcept;
  /// 60B8h for the next cycle.
  [[nodiscard]] std::uint16_t function() const noexcept { return armed_ ? touch_probe::latch_once(edge_) : 0; }
  /// A hit now is latched, or has been.
  [[nodiscard]] bool armed() const noexcept { return armed_; }
  /// There is the position of a hit. That is one cycle after it was seen: a drive may tell it in another PDO than that
  /// there is one.
  [[nodiscard]] bool latched() const noexcept { return cycles_ == kTaken; }
  [[nodiscard]] std::int32_t counts() const noexcept { return counts_; }

 private:
  static constexpr int kTaken = 2;

  TouchProbeEdge edge_;
  bool armed_ = false;
  int cycles_ = 0;  ///< since the edge was seen, up to that in which its position was taken
  std::int32_t counts_ = 0;
};

}  // namespace rmac
