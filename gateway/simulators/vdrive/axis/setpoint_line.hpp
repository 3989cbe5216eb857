#pragma once

#include <algorithm>

#include "gateway/simulators/vdrive/axis/profile.hpp"

namespace rmac::vdrive {

/// Setpoints that the master sends one after the other (cyclic synchronous and interpolated position): the demand goes
/// along a straight line to each, which it reaches when the next one is due. In counts and seconds.
class SetpointLine {
 public:
  /// The setpoint is where the demand is.
  void stay(double position) noexcept {
    setpoint_ = position;
    left_s_ = 0;
  }
  /// A setpoint, the next of which is due in `within_s`.
  void take(double setpoint, double within_s) noexcept {
    setpoint_ = setpoint;
    left_s_ = within_s;
  }
  /// Moves the demand on; it keeps within the two positions.
  void follow(Demand& demand, double least, double most, double dt) noexcept {
    setpoint_ = std::clamp(setpoint_, least, most);
    demand.acceleration = 0;
    if (left_s_ < dt / 2) {
      demand.position = setpoint_;
      demand.velocity = 0;
      return;
    }
    demand.velocity = (setpoint_ - demand.position) / std::max(left_s_, dt);
    demand.position += demand.velocity * dt;
    left_s_ -= dt;
  }

 private:
  double setpoint_ = 0;
  double left_s_ = 0;
};

}  // namespace rmac::vdrive
