#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace rmac::gateway {

/// Up to four points of the difference of two solids, and the points of both from which each comes.
class Simplex {
 public:
  using Vector3d = Eigen::Vector3d;

  void add(const Vector3d& first, const Vector3d& second) noexcept {
    difference_[count_] = first - second;
    first_[count_] = first;
    second_[count_++] = second;
  }
  [[nodiscard]] bool holds(const Vector3d& difference) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      if (difference_[i] == difference) return true;
    }
    return false;
  }

  /// Keeps the corners whose face lies nearest to the origin, and returns its nearest point. Every face is tried and
  /// the nearest taken: with at most 15 of them that is quick, and it does not depend on which side rounding puts the
  /// origin.
  Vector3d nearest();
  /// The points on both solids that the last `nearest` stands for.
  [[nodiscard]] Vector3d on_first() const noexcept { return sum(first_); }
  [[nodiscard]] Vector3d on_second() const noexcept { return sum(second_); }
  /// The origin is inside: four corners are left.
  [[nodiscard]] bool encloses() const noexcept { return count_ == 4; }

 private:
  [[nodiscard]] Vector3d sum(const std::array<Vector3d, 4>& points) const noexcept {
    Vector3d total = Vector3d::Zero();
    for (std::size_t i = 0; i < count_; ++i) total += weight_[i] * points[i];
    return total;
  }

  std::size_t count_ = 0;
  std::array<Vector3d, 4> difference_{}, first_{}, second_{};
  std::array<double, 4> weight_{};
};

}  // namespace rmac::gateway
