#pragma once

#include <cmath>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// Algebra of vectors: pure, and real-time safe.

[[nodiscard]] inline double dot(const Vector& a, const Vector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// a + factor · b
[[nodiscard]] inline Vector plus(const Vector& a, double factor, const Vector& b) noexcept {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
[[nodiscard]] inline Vector difference(const Vector& a, const Vector& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vector scaled(double factor, const Vector& a) noexcept {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
[[nodiscard]] inline double norm(const Vector& a) noexcept {
  return std::hypot(a[0], a[1], a[2]);
}
[[nodiscard]] inline double distance(const Vector& a, const Vector& b) noexcept {
  return norm(difference(a, b));
}
/// The direction of a vector that is not zero.
[[nodiscard]] inline Vector unit(const Vector& a) noexcept {
  return scaled(1 / norm(a), a);
}

}  // namespace rmac
