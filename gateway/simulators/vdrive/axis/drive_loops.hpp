#pragma once

#include <algorithm>

#include "gateway/simulators/vdrive/axis/profile.hpp"
#include "gateway/simulators/vdrive/axis/shaft.hpp"

namespace rmac::vdrive {

/// A drive's own loops of position and velocity: they make the torque that lets the shaft follow a demand.
class DriveLoops {
 public:
  /// Power comes on where the load pulls with this torque.
  void start(double load_nm) noexcept { integral_nm_ = load_nm; }
  /// A torque that stood beside these loops is theirs from now on.
  void take_up(double torque_nm) noexcept { integral_nm_ += torque_nm; }

  /// The torque in N·m; the integral part keeps within `most_torque`.
  [[nodiscard]] double torque(const Demand& demand, const Shaft& shaft, double most_torque, double dt) noexcept {
    const double position_error = demand.position - shaft.position();
    const double velocity_error = demand.velocity - shaft.velocity();
    const double gain = shaft.nm_per_count() * kVelocityBandwidth * kPositionBandwidth;
    integral_nm_ += gain * kIntegral * position_error * dt;
    integral_nm_ = std::clamp(integral_nm_, -most_torque, most_torque);
    return shaft.nm_per_count() * (demand.acceleration + kVelocityBandwidth * velocity_error) + gain * position_error +
           integral_nm_;
  }

 private:
  // Bandwidths of the loops in 1/s, well apart from each other and from the current loop's 5000 rad/s.
  static constexpr double kVelocityBandwidth = 700;
  static constexpr double kPositionBandwidth = 150;
  static constexpr double kIntegral = 50;

  double integral_nm_ = 0;
};

}  // namespace rmac::vdrive
