#include "gateway/collision/distance/gjk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gateway/collision/distance/simplex.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kMostSteps = 200;
constexpr double kRelative = 1e-10;  ///< between the bounds
constexpr double kMeet_mm = 1e-9;

/// One pose seen from the other, so that only one of the solids has to be turned.
struct Pair {
  const Convex& first;
  const Convex& second;
  Isometry3d relative;  ///< of the second, in the first one's frame

  [[nodiscard]] Vector3d first_point(const Vector3d& direction) const { return first.support(direction); }
  [[nodiscard]] Vector3d second_point(const Vector3d& direction) const {
    return relative * second.support(relative.linear().transpose() * direction);
  }
  /// How far the solids overlap along a unit direction.
  [[nodiscard]] double overlap(const Vector3d& direction) const {
    return (first_point(direction) - second_point(-direction)).dot(direction) + first.rounded() + second.rounded();
  }
};

}  // namespace

Apart distance(const Convex& first, const Isometry3d& first_pose, const Convex& second, const Isometry3d& second_pose,
               double enough_mm, const Vector3d& towards) {
  const Pair pair{first, second, first_pose.inverse() * second_pose};
  const double rounded = first.rounded() + second.rounded();
  Simplex simplex;
  Vector3d nearest = first_pose.linear().transpose() * -towards;
  if (nearest.squaredNorm() == 0) nearest = first.middle() - pair.relative * second.middle();
  if (nearest.squaredNorm() == 0) nearest = Vector3d(1, 0, 0);
  double least = -1e300, most = 1e300;
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector3d a = pair.first_point(-nearest), b = pair.second_point(nearest);
    const Vector3d difference = a - b;
    least = std::max(least, difference.dot(nearest) / nearest.norm());
    if (least - rounded > enough_mm || (least > 0 && most - least <= kRelative * most) || simplex.holds(difference))
      break;
    simplex.add(a, b);
    const Vector3d closer = simplex.nearest();
    const double size = closer.norm();
    if (size >= most || size < kMeet_mm || simplex.encloses()) {
      if (size < most) most = size;
      break;
    }
    nearest = closer;
    most = size;
  }
  Apart apart;
  if (most == 1e300) {
    // Far enough before there was a point.
    most = std::max(least, 0.0);
    simplex.add(pair.first_point(-nearest), pair.second_point(nearest));
    static_cast<void>(simplex.nearest());
    most = (simplex.on_first() - simplex.on_second()).norm();
  }
  Vector3d on_first = simplex.on_first(), on_second = simplex.on_second();
  if (const double gap = (on_second - on_first).norm(); gap > 0) {
    const Vector3d across = (on_second - on_first) / gap;
    on_first += across * first.rounded();
    on_second -= across * second.rounded();
  }
  apart.on_first = first_pose * on_first;
  apart.on_second = first_pose * on_second;
  apart.most = most < kMeet_mm ? 0 : std::max(0.0, most - rounded);
  apart.least = apart.most == 0 ? 0 : std::clamp(least - rounded, 0.0, apart.most);
  return apart;
}

double overlap_depth(const Convex& first, const Isometry3d& first_pose, const Convex& second,
                     const Isometry3d& second_pose) {
  const Pair pair{first, second, first_pose.inverse() * second_pose};
  // Directions spread evenly over the sphere (a Fibonacci lattice), then better ones from the best of them.
  constexpr int kDirections = 256;
  constexpr std::size_t kStarts = 3;
  std::array<std::pair<double, Vector3d>, kStarts> starts;
  starts.fill({1e300, Vector3d::UnitX()});
  const auto offer = [&](const Vector3d& direction) {
    const double depth = pair.overlap(direction);
    if (depth < starts.back().first) {
      starts.back() = {depth, direction};
      std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    }
  };
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, around = i * std::numbers::pi * (3 - std::sqrt(5.0));
    offer({std::sqrt(1 - z * z) * std::cos(around), std::sqrt(1 - z * z) * std::sin(around), z});
  }
  for (int c = 0; c < 3; ++c) {
    for (const double sign : {1.0, -1.0}) {
      offer(sign * Vector3d::Unit(c));
      offer(sign * pair.relative.linear().col(c));
    }
  }
  // Moved apart along a direction a little more than needed, the shortest way between the two is a better direction:
  // what is left of the overlap along it is no more. It ends where the two are the same.
  constexpr int kMostSteps = 30;
  double least = 1e300;
  for (auto [depth, direction] : starts) {
    for (int step = 0; step < kMostSteps && depth > 0; ++step) {
      const double aside = depth + 1e-3 + 0.1 * depth;
      Isometry3d moved = pair.relative;
      moved.pretranslate(direction * aside);
      const Apart apart = distance(first, Isometry3d::Identity(), second, moved);
      const Vector3d between = apart.on_second - apart.on_first;
      if (!(between.norm() > 1e-9)) break;
      const double there = pair.overlap(between.normalized());
      if (!(there < depth * (1 - 1e-6))) break;
      depth = there, direction = between.normalized();
    }
    least = std::min(least, depth);
  }
  return std::max(0.0, least);
}

}  // namespace rmac::gateway
