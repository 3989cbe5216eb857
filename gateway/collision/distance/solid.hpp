#pragma once

#include <memory>
#include <variant>

#include "gateway/collision/distance/gjk.hpp"
#include "gateway/collision/distance/triangle_tree.hpp"

namespace rmac::gateway {

/// A convex solid, or what a closed surface of triangles encloses.
class Solid {
 public:
  explicit Solid(const Convex& convex) : shape_(convex), middle_(convex.middle()), reach_(convex.reach()) {}
  explicit Solid(const TriangleMesh& mesh) : Solid(std::make_shared<const TriangleTree>(mesh)) {}

  /// A point, and how far everything of the solid is from it at most.
  [[nodiscard]] const Eigen::Vector3d& middle() const noexcept { return middle_; }
  [[nodiscard]] double reach() const noexcept { return reach_; }

  [[nodiscard]] const Convex* convex() const noexcept { return std::get_if<Convex>(&shape_); }
  /// Where there is no convex.
  [[nodiscard]] const TriangleTree& tree() const { return *std::get<std::shared_ptr<const TriangleTree>>(shape_); }

 private:
  explicit Solid(const std::shared_ptr<const TriangleTree>& tree)
      : shape_(tree), middle_(tree->bounds().center()), reach_(tree->bounds().diagonal().norm() / 2) {}

  std::variant<Convex, std::shared_ptr<const TriangleTree>> shape_;
  Eigen::Vector3d middle_;
  double reach_;
};

/// How far two solids are apart; 0 also where one is inside of the other. Beyond `precise_mm` the bounds may be as far
/// apart as half of the distance: that is less work, and who advances by `least` needs no more.
[[nodiscard]] Apart distance(const Solid& first, const Eigen::Isometry3d& first_pose, const Solid& second,
                             const Eigen::Isometry3d& second_pose, double precise_mm);

/// How far two solids that meet are in each other: of convex ones, the least way by which they would part. Where a mesh
/// takes part, how far the deepest of some points of either is inside of the other: they need at least that to part.
[[nodiscard]] double overlap_depth(const Solid& first, const Eigen::Isometry3d& first_pose, const Solid& second,
                                   const Eigen::Isometry3d& second_pose);

}  // namespace rmac::gateway
