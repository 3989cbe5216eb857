#pragma once

#include <cmath>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// Arithmetic of vectors. All of it is pure, allocates nothing and is real-time safe.

[[nodiscard]] inline double dot(const Vector& a, const Vector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// a + f b
[[nodiscard]] inline Vector along(const Vector& a, double f, const Vector& b) noexcept {
  return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]};
}
[[nodiscard]] inline Vector difference(const Vector& a, const Vector& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vector scaled(double f, const Vector& a) noexcept {
  return {f * a[0], f * a[1], f * a[2]};
}
[[nodiscard]] inline double norm(const Vector& a) noexcept {
  return std::hypot(a[0], a[1], a[2]);
}
[[nodiscard]] inline double distance(const Vector& a, const Vector& b) noexcept {
  return norm(difference(a, b));
}
/// `a` must be finite and not zero.
[[nodiscard]] inline Vector unit(const Vector& a) noexcept {
  return scaled(1 / norm(a), a);
}
[[nodiscard]] inline bool finite(const Vector& a) noexcept {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

}  // namespace rmac
