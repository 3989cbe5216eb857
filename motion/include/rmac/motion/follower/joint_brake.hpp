#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/servo/setpoint.hpp"
#include "rmac/motion/state_to_state.hpp"

namespace rmac {

/// A stop that asks nobody: every joint comes to rest by itself, from whatever state it is in, as fast as its own
/// acceleration and jerk allow (docs/derivations/state-to-state.md). The tool leaves its path where joints need
/// different times. Built off the servo thread; then real-time safe.
class JointBrake {
 public:
  explicit JointBrake(std::span<const JointLimits> joints);
  /// A joint without a bound of its acceleration or jerk stands at once.
  explicit JointBrake(std::vector<MotionBounds> bounds);

  /// Brakes from a setpoint, whose velocities and accelerations count.
  void begin(const Setpoint& from) noexcept;
  /// The time in which all joints stand, s.
  [[nodiscard]] double duration() const noexcept { return duration_; }
  /// Positions, velocities and accelerations `t` seconds after `begin`; the rest of `setpoint` stays as it is.
  void at(double t, Setpoint& setpoint) const noexcept;

 private:
  std::vector<MotionBounds> bounds_;
  std::vector<JerkProfile> profiles_;
  double duration_ = 0;
};

}  // namespace rmac
