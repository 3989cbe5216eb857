#pragma once

#include <cstdint>

namespace rmac::vdrive {

/// One of the two touch probes of a drive (CiA 402-2: one half of 60B8h and 60B9h, and two of 60BAh to 60BDh).
class TouchProbe {
 public:
  /// Whether a function (a half of 60B8h) is one that this drive has: its source is the input or the index pulse.
  [[nodiscard]] static bool knows(unsigned function) noexcept { return (function & 0x08U) == 0; }

  void set_function(unsigned function) noexcept {
    if ((function & kEnable) == 0) status_ = 0;
    if ((function & kAtRise) == 0) status_ &= ~kHasRise;
    if ((function & kAtFall) == 0) status_ &= ~kHasFall;
    function_ = function;
    if ((function & kEnable) != 0) status_ |= kEnabled;
  }
  /// The input is at this level while the drive is at `position`.
  void see(bool closed, std::int32_t position) noexcept {
    if (closed != closed_ && !by_index()) take(closed, position);
    closed_ = closed;
  }
  /// The index pulse comes at `position`; it rises there, and falls within a count.
  void see_index(std::int32_t position) noexcept {
    if (by_index()) take(true, position);
  }

  [[nodiscard]] unsigned status() const noexcept { return status_; }
  [[nodiscard]] bool closed() const noexcept { return closed_; }
  [[nodiscard]] std::int32_t at_rise() const noexcept { return at_rise_; }
  [[nodiscard]] std::int32_t at_fall() const noexcept { return at_fall_; }

 private:
  // Bits of the function
  static constexpr unsigned kEnable = 1, kContinuous = 2, kIndexPulse = 4, kAtRise = 0x10, kAtFall = 0x20;
  // Bits of the status
  static constexpr unsigned kEnabled = 1, kHasRise = 2, kHasFall = 4;

  [[nodiscard]] bool by_index() const noexcept { return (function_ & kIndexPulse) != 0; }
  void take(bool rises, std::int32_t position) noexcept {
    const unsigned stored = rises ? kHasRise : kHasFall;
    const bool waits = (function_ & kEnable) != 0 && (function_ & (rises ? kAtRise : kAtFall)) != 0;
    if (!waits || ((function_ & kContinuous) == 0 && (status_ & stored) != 0)) return;
    (rises ? at_rise_ : at_fall_) = position;
    status_ |= stored;
  }

  unsigned function_ = 0;
  unsigned status_ = 0;
  std::int32_t at_rise_ = 0, at_fall_ = 0;
  bool closed_ = false;
};

}  // namespace rmac::vdrive
