#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// A stop that removes power: which drives have come to rest, so that each loses its power as it does. Drives are the
/// actuators', then the spindles'. Real-time safe.
class RestWatch {
 public:
  RestWatch(std::size_t drives, double period_s) noexcept : drives_(drives), period_s_(period_s) {}

  /// Drives begin to brake by themselves.
  void begin() noexcept;
  /// One cycle of it, before its drives are looked at.
  void begin_cycle() noexcept { ++cycles_; }
  /// Where an encoder shows the drive, of so many counts a turn.
  void look_at_counts(std::size_t drive, std::int64_t counts, double counts_per_turn) noexcept;
  /// What a drive without an encoder says of its speed: it stands at 0 rpm, not at any steady speed.
  void look_at_speed(std::size_t drive, double rpm) noexcept;

  [[nodiscard]] bool reached(std::size_t drive) const noexcept { return rest_[drive].reached; }
  [[nodiscard]] bool all_reached() const noexcept;

 private:
  struct Rest {
    std::int64_t mark = 0;   ///< counts at which it seems to stand
    std::int64_t still = 0;  ///< cycles that it has been there
    bool reached = false;
  };
  void look(Rest& drive, bool stays) noexcept;

  std::size_t drives_;
  double period_s_;
  std::array<Rest, kMaxJoints + kMaxSpindles> rest_{};
  std::int64_t cycles_ = 0;
};

}  // namespace rmac
