#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace rmac::gateway {

/// A convex solid known by the point that lies farthest along a direction, so that nothing round is cut into facets. In
/// a frame of its own, mm.
class Convex {
 public:
  using Vector3d = Eigen::Vector3d;

  [[nodiscard]] static Convex box(const Vector3d& half_size) { return {Kind::Box, half_size, 0}; }
  /// Along z from -half_height to half_height; `rounded` in every direction: a sphere is a point that is rounded.
  [[nodiscard]] static Convex cone(double bottom_radius, double top_radius, double half_height, double rounded = 0) {
    return {Kind::Cone, {bottom_radius, top_radius, half_height}, rounded};
  }
  [[nodiscard]] static Convex sphere(double radius) { return {Kind::Box, Vector3d::Zero(), radius}; }
  [[nodiscard]] static Convex triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    Convex made(Kind::Triangle, Vector3d::Zero(), 0);
    made.corners_ = {a, b, c};
    return made;
  }

  /// The farthest point along `direction`, which need not be unit, of the solid without its rounding.
  [[nodiscard]] Vector3d support(const Vector3d& direction) const noexcept {
    if (kind_ == Kind::Box) {
      return {std::copysign(size_[0], direction[0]), std::copysign(size_[1], direction[1]),
              std::copysign(size_[2], direction[2])};
    }
    if (kind_ == Kind::Cone) {
      const double across = std::sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
      const bool top = direction[2] * 2 * size_[2] > (size_[0] - size_[1]) * across;
      const double radius = top ? size_[1] : size_[0];
      const double z = top ? size_[2] : -size_[2];
      if (across == 0) return {0, 0, z};
      return {radius * direction[0] / across, radius * direction[1] / across, z};
    }
    const double a = corners_[0].dot(direction), b = corners_[1].dot(direction), c = corners_[2].dot(direction);
    return a >= b && a >= c ? corners_[0] : b >= c ? corners_[1] : corners_[2];
  }
  [[nodiscard]] double rounded() const noexcept { return rounded_; }

  /// A point inside, and how far everything is from it at most.
  [[nodiscard]] Vector3d middle() const {
    return kind_ == Kind::Triangle ? Vector3d((corners_[0] + corners_[1] + corners_[2]) / 3) : Vector3d::Zero();
  }
  [[nodiscard]] double reach() const {
    if (kind_ == Kind::Box) return size_.norm() + rounded_;
    if (kind_ == Kind::Cone) return std::hypot(std::max(size_[0], size_[1]), size_[2]) + rounded_;
    double most = 0;
    for (const Vector3d& corner : corners_) most = std::max(most, (corner - middle()).norm());
    return most;
  }

 private:
  enum class Kind { Box, Cone, Triangle };
  Convex(Kind kind, Vector3d size, double rounded) : kind_(kind), rounded_(rounded), size_(std::move(size)) {}

  Kind kind_;
  double rounded_;
  Vector3d size_;
  std::array<Vector3d, 3> corners_{};
};

}  // namespace rmac::gateway
