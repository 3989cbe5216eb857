#pragma once

#include <Eigen/Geometry>

#include "gateway/collision/distance/convex.hpp"

namespace rmac::gateway {

/// How far two solids are apart. The truth is between `least` and `most`; both are 0 where they meet.
struct Apart {
  double least = 0, most = 0;
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();  ///< nearest points, mm
};

/// Distance of two convex solids by Gilbert, Johnson and Keerthi's method ("A fast procedure for computing the distance
/// between complex objects in three-dimensional space", 1988). It ends by the bound from below that its support planes
/// give, so that `least` is proven, whatever the shapes: advancing by it never jumps over a contact. Stops early where
/// they are farther apart than `enough_mm`. `towards`, from the first to the second, is where to begin; zero: from
/// their middles. Points are in the frame in which both poses are.
[[nodiscard]] Apart distance(const Convex& first, const Eigen::Isometry3d& first_pose, const Convex& second,
                             const Eigen::Isometry3d& second_pose, double enough_mm = 1e300,
                             const Eigen::Vector3d& towards = Eigen::Vector3d::Zero());

/// How far two convex solids that meet would have to be moved to part: an upper bound, the least that a
/// search over directions finds. 0 where they do not meet.
[[nodiscard]] double overlap_depth(const Convex& first, const Eigen::Isometry3d& first_pose, const Convex& second,
                                   const Eigen::Isometry3d& second_pose);

}  // namespace rmac::gateway
