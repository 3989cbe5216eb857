#pragma once

#include <cmath>
#include <cstddef>

#include "clients/legacy/program/writer.hpp"

namespace rmac::legacy {

[[nodiscard]] inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// `point` and `amount` of `direction`.
[[nodiscard]] inline Point along(const Point& point, double amount, const Point& direction) {
  return {point[0] + amount * direction[0], point[1] + amount * direction[1], point[2] + amount * direction[2]};
}
[[nodiscard]] inline Point difference(const Point& a, const Point& b) {
  return along(a, -1, b);
}
[[nodiscard]] inline double length(const Point& vector) {
  return std::hypot(vector[0], vector[1], vector[2]);
}
[[nodiscard]] inline Point scaled(double factor, const Point& vector) {
  return along({}, factor, vector);
}

/// Points are turned about the origin first, then shifted, in mm.
struct Placement {
  Point x = legacy::unit_axis(0), y = legacy::unit_axis(1), z = legacy::unit_axis(2);  ///< where the axes turn to
  Point shift{};

  [[nodiscard]] Point turned(const Point& vector) const {
    return along(along(scaled(vector[0], x), vector[1], y), vector[2], z);
  }
  [[nodiscard]] Point placed(const Point& point) const { return along(turned(point), 1, shift); }
  /// First `inner`, then this.
  [[nodiscard]] Placement after(const Placement& inner) const {
    return {turned(inner.x), turned(inner.y), turned(inner.z), placed(inner.shift)};
  }
  /// What leads back, where it is a turn or a mirror.
  [[nodiscard]] Placement back() const {
    const Placement turn{{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}, {}};
    return {turn.x, turn.y, turn.z, scaled(-1, turn.turned(shift))};
  }
  [[nodiscard]] bool mirrors() const { return dot(cross(x, y), z) < 0; }
  bool operator==(const Placement&) const = default;
};

}  // namespace rmac::legacy
