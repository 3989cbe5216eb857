#include "gateway/collision/distance/simplex.hpp"

#include <Eigen/Dense>

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;

/// Weights, all positive, of the point of a face nearest to the origin; false where it is not inside the face, or the
/// face has no extent.
bool inside(const std::array<const Vector3d*, 4>& corners, std::size_t count, std::array<double, 4>& weights) {
  if (count == 1) {
    weights[0] = 1;
    return true;
  }
  const Vector3d& a = *corners[0];
  const Vector3d ab = *corners[1] - a;
  if (count == 2) {
    const double size = ab.squaredNorm();
    if (size == 0) return false;
    weights[1] = -a.dot(ab) / size;
    weights[0] = 1 - weights[1];
    return weights[0] > 0 && weights[1] > 0;
  }
  const Vector3d ac = *corners[2] - a;
  if (count == 3) {
    const Vector3d normal = ab.cross(ac);
    const double size = normal.squaredNorm();
    if (size <= 1e-28 * ab.squaredNorm() * ac.squaredNorm()) return false;
    weights[1] = -normal.dot(a.cross(ac)) / size;
    weights[2] = -normal.dot(ab.cross(a)) / size;
    weights[0] = 1 - weights[1] - weights[2];
    return weights[0] > 0 && weights[1] > 0 && weights[2] > 0;
  }
  const Vector3d ad = *corners[3] - a;
  const double volume = ab.dot(ac.cross(ad));
  if (std::abs(volume) <= 1e-14 * ab.norm() * ac.norm() * ad.norm()) return false;
  weights[1] = -a.dot(ac.cross(ad)) / volume;
  weights[2] = -ab.dot(a.cross(ad)) / volume;
  weights[3] = -ab.dot(ac.cross(a)) / volume;
  weights[0] = 1 - weights[1] - weights[2] - weights[3];
  return weights[0] > 0 && weights[1] > 0 && weights[2] > 0 && weights[3] > 0;
}

}  // namespace

Vector3d Simplex::nearest() {
  double best = 0;
  unsigned best_face = 0;
  std::array<double, 4> best_weights{};
  Vector3d best_point = Vector3d::Zero();
  for (unsigned face = 1; face < 1U << count_; ++face) {
    std::array<const Vector3d*, 4> corners{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (face >> i & 1U) corners[count++] = &difference_[i];
    }
    std::array<double, 4> weights{};
    if (!inside(corners, count, weights)) continue;
    Vector3d point = Vector3d::Zero();
    if (count < 4) {
      for (std::size_t i = 0; i < count; ++i) point += weights[i] * *corners[i];
    }
    const double size = point.squaredNorm();
    if (best_face != 0 && size >= best) continue;
    best = size, best_face = face, best_weights = weights, best_point = point;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if ((best_face >> i & 1U) == 0) continue;
    difference_[kept] = difference_[i], first_[kept] = first_[i], second_[kept] = second_[i];
    weight_[kept] = best_weights[kept];
    ++kept;
  }
  count_ = kept;
  return best_point;
}

}  // namespace rmac::gateway
