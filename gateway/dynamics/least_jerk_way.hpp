#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "rmac/motion/joint.hpp"
#include "rmac/motion/limits.hpp"

namespace rmac::gateway {

/// One joint's way from rest to rest by the polynomial of least jerk, s(τ) = 10 τ³ - 15 τ⁴ + 6 τ⁵ over τ from 0 to 1.
struct LeastJerkWay {
  double from = 0, by = 0;  ///< mm or degrees
  double time_s = 0;

  /// How long a way of this length takes at this share of the joint's limits: peaks of the derivatives of s are 1.875,
  /// 5.774 and 60.
  [[nodiscard]] static double least_time_s(const JointLimits& limits, double length, double share) {
    return std::max({1.875 * length / (share * limits.max_speed),
                     std::sqrt(5.774 * length / (share * limits.max_acceleration)),
                     std::cbrt(60 * length / (share * limits.max_jerk))});
  }
  [[nodiscard]] LeastJerkWay back() const { return {from + by, -by, time_s}; }
  /// Position, velocity and acceleration.
  [[nodiscard]] std::array<double, 3> at(double t_s) const {
    const double u = std::clamp(t_s / time_s, 0.0, 1.0);
    return {from + by * u * u * u * (10 + u * (-15 + 6 * u)), by * u * u * (30 + u * (-60 + 30 * u)) / time_s,
            by * u * (60 + u * (-180 + 120 * u)) / (time_s * time_s)};
  }
};

}  // namespace rmac::gateway
