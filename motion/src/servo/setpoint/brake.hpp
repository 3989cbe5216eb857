#pragma once

#include <array>
#include <span>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// A stop that keeps power: velocities of all joints fall to zero in step, so that the tool stays on its path as far as
/// that is straight. Real-time safe.
class Brake {
 public:
  /// From these velocities, none faster than its joint's deceleration; a deceleration of 0 asks for no time.
  void begin(std::span<const double> velocities, std::span<const double> decelerations) noexcept;
  /// One cycle.
  void step(double period_s) noexcept;
  /// All joints stand.
  [[nodiscard]] bool done() const noexcept { return braked_s_ >= takes_s_; }
  [[nodiscard]] double velocity(std::size_t joint) const noexcept { return from_[joint] * left(); }
  [[nodiscard]] double acceleration(std::size_t joint) const noexcept {
    return left() > 0 ? -from_[joint] / takes_s_ : 0;
  }

 private:
  /// Share of the velocities at the beginning.
  [[nodiscard]] double left() const noexcept { return takes_s_ > 0 ? 1 - braked_s_ / takes_s_ : 0; }

  std::array<double, kMaxJoints> from_{};
  double takes_s_ = 0;
  double braked_s_ = 0;
};

}  // namespace rmac
