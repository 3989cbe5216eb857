#pragma once

#include <algorithm>
#include <cmath>

namespace rmac::vdrive {

/// What a drive's own loops are asked to follow, in counts of the encoder and seconds.
struct Demand {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;

  /// Towards a velocity, at most so much faster or slower a second.
  void ramp(double to_velocity, double acceleration_bound, double dt) noexcept {
    const double change = std::clamp(to_velocity - velocity, -acceleration_bound * dt, acceleration_bound * dt);
    acceleration = change / dt;
    position += (velocity + change / 2) * dt;
    velocity += change;
  }

  /// Towards a position and to rest there, by a trapezoid. True on arrival.
  bool approach(double target, double top_velocity, double acceleration_bound, double deceleration,
                double dt) noexcept {
    const double way = target - position;
    const double direction = way < 0 ? -1.0 : 1.0;
    // The velocity from which it can still stop there, a step from now.
    const double stoppable = std::sqrt(2 * deceleration * std::abs(way)) - deceleration * dt / 2;
    const double wanted = direction * std::min(top_velocity, std::max(stoppable, 0.0));
    const bool slows = std::abs(wanted) < std::abs(velocity) || wanted * velocity < 0;
    const double last_step = deceleration * dt * dt;
    if (std::abs(way) <= last_step && std::abs(velocity) <= 2 * deceleration * dt) {
      position = target;
      velocity = acceleration = 0;
      return true;
    }
    ramp(wanted, slows ? deceleration : acceleration_bound, dt);
    return false;
  }
};

}  // namespace rmac::vdrive
