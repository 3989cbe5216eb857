#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "rmac/motion/pose.hpp"

namespace rmac::curves {

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
[[nodiscard]] inline Vector unit(const Vector& a) noexcept {
  return scaled(1 / norm(a), a);
}
[[nodiscard]] inline bool finite(const Vector& a) noexcept {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// A number for a message: as many digits as a person needs.
[[nodiscard]] inline std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.7g", value);
  return buffer;
}

}  // namespace rmac::curves
