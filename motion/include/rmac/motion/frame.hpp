#pragma once

#include <array>
#include <cmath>

#include "rmac/motion/pose.hpp"

namespace rmac {

/// Algebra of rigid frames: pure, and real-time safe. Quaternions are taken to be unit; `check_frame` and `normalized`
/// see to that at the border.

/// Turns a free vector of the frame into the parent's: q v q*.
[[nodiscard]] inline Vector rotate(const std::array<double, 4>& q, const Vector& v) noexcept {
  const auto [w, x, y, z] = q;
  // t = 2 (x y z) × v saves half of the products of q v q*.
  const double tx = 2 * (y * v[2] - z * v[1]);
  const double ty = 2 * (z * v[0] - x * v[2]);
  const double tz = 2 * (x * v[1] - y * v[0]);
  return {v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx};
}

/// A point of the frame in the parent's coordinates.
[[nodiscard]] inline Vector apply_to_point(const Frame& frame, const Vector& point) noexcept {
  const Vector r = rotate(frame.q, point);
  return {frame.p[0] + r[0], frame.p[1] + r[1], frame.p[2] + r[2]};
}

/// A direction, velocity or derivative of the frame in the parent's coordinates.
[[nodiscard]] inline Vector apply_to_vector(const Frame& frame, const Vector& vector) noexcept {
  return rotate(frame.q, vector);
}

[[nodiscard]] inline ToolPose apply_to_pose(const Frame& frame, const ToolPose& pose) noexcept {
  return {apply_to_point(frame, pose.tip), apply_to_vector(frame, pose.axis)};
}

/// `outer` · `inner`: turns coordinates of the inner frame into those of the outer frame's parent.
[[nodiscard]] inline Frame compose(const Frame& outer, const Frame& inner) noexcept {
  const auto [aw, ax, ay, az] = outer.q;
  const auto [bw, bx, by, bz] = inner.q;
  return {apply_to_point(outer, inner.p),
          {aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
           aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw}};
}

[[nodiscard]] inline Frame inverse(const Frame& frame) noexcept {
  const std::array<double, 4> q{frame.q[0], -frame.q[1], -frame.q[2], -frame.q[3]};
  const Vector p = rotate(q, frame.p);
  return {{-p[0], -p[1], -p[2]}, q};
}

/// The frame's z axis in the parent's coordinates: the tool axis of a frame that a client sends.
[[nodiscard]] inline Vector z_axis(const Frame& frame) noexcept {
  return rotate(frame.q, {0, 0, 1});
}

/// The tool pose that a client's frame stands for.
[[nodiscard]] inline ToolPose tool_pose(const Frame& frame) noexcept {
  return {frame.p, z_axis(frame)};
}

/// Length of the quaternion brought to 1. Does nothing to a zero quaternion, which `check_frame` refuses.
[[nodiscard]] inline Frame normalized(const Frame& frame) noexcept {
  double sum = 0;
  for (const double c : frame.q) sum += c * c;
  Frame unit = frame;
  if (sum > 0) {
    for (double& c : unit.q) c /= std::sqrt(sum);
  }
  return unit;
}

/// The frame at `p` whose z axis points along `axis`, turned the shortest way from the parent's z (about x where the
/// axis is exactly opposite). `axis` need not be unit, but must be finite and not zero.
[[nodiscard]] inline Frame frame_from_axis(const Vector& p, const Vector& axis) noexcept {
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  const Vector a{axis[0] / length, axis[1] / length, axis[2] / length};
  const double lean = std::hypot(a[0], a[1]);
  if (lean == 0) return {p, a[2] > 0 ? std::array<double, 4>{1, 0, 0, 0} : std::array<double, 4>{0, 1, 0, 0}};
  // Half of the angle from z, by atan2 so that axes close to ±z keep all their digits.
  const double half = std::atan2(lean, a[2]) / 2;
  return {p, {std::cos(half), -std::sin(half) * a[1] / lean, std::sin(half) * a[0] / lean, 0}};
}

}  // namespace rmac
