#pragma once

#include <cmath>
#include <numbers>

#include "rmac/motion/axis.hpp"
#include "rmac/motion/pose.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::modules {

inline constexpr double kRadPerDegree = std::numbers::pi / 180;

[[nodiscard]] inline double length(const Vector& a) noexcept {
  return std::sqrt(dot(a, a));
}
/// The axis of one joint in the machine frame, where it lies while all joints of its chain stand at 0: a slide along
/// `direction`, or a turn about the line through `point`. It tells how the tool moves against the part, whichever of
/// the two the joint really carries. `direction` has unit length.
struct ScrewAxis {
  JointType type = JointType::Linear;
  Vector direction{0, 0, 1};
  Vector point{0, 0, 0};
};

/// A turn by one angle about one axis: exp(ξ θ) of a zero-pitch screw.
class Turn {
 public:
  Turn() = default;
  Turn(const ScrewAxis& axis, double degrees) noexcept
      : direction_(axis.direction),
        point_(axis.point),
        sin_(std::sin(degrees * kRadPerDegree)),
        cos_(std::cos(degrees * kRadPerDegree)) {}

  /// Rodrigues' formula.
  [[nodiscard]] Vector vector(const Vector& v) const noexcept {
    const Vector aside = cross(direction_, v);
    const double along = dot(direction_, v) * (1 - cos_);
    return {cos_ * v[0] + sin_ * aside[0] + along * direction_[0],
            cos_ * v[1] + sin_ * aside[1] + along * direction_[1],
            cos_ * v[2] + sin_ * aside[2] + along * direction_[2]};
  }
  [[nodiscard]] Vector location(const Vector& x) const noexcept { return plus(point_, 1, vector(plus(x, -1, point_))); }

 private:
  Vector direction_{0, 0, 1};
  Vector point_{0, 0, 0};
  double sin_ = 0;
  double cos_ = 1;
};

}  // namespace rmac::modules
