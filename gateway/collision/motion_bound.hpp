#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/collision/scene_body.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {

/// Where the links stand, and how far two bodies can move against each other at most while the joints go straight from
/// here to somewhere else. Of a turn this is its angle times the radius on which the farther point of a body runs, seen
/// from whichever of the two it is less (docs/derivations/motion-bound.md).
class Posture {
 public:
  explicit Posture(const LinkChain& chain)
      : chain_(&chain), frames_(chain.link_count()), links_(chain.link_count()), axes_(chain.link_count() - 1) {}

  void set(std::span<const double> joints);
  [[nodiscard]] Eigen::Isometry3d pose(const SceneBody& body) const { return links_[body.link] * body.home; }

  /// How far from the axis of each joint a point of a body may be, by the link before the joint.
  using Radii = std::array<double, kMaxJoints>;
  void radii(const SceneBody& body, Radii& radii) const;

  /// `way`: what each joint goes, all positive. Radii are those of the two bodies here.
  [[nodiscard]] double bound(const SceneBody& first, const Radii& first_radii, const SceneBody& second,
                             const Radii& second_radii, std::span<const double> way) const;

 private:
  struct Axis {
    Eigen::Vector3d direction, point;
  };

  const LinkChain* chain_;
  std::vector<Frame> frames_;
  std::vector<Eigen::Isometry3d> links_;
  std::vector<Axis> axes_;  ///< of the joint behind each link, in the machine frame
};

}  // namespace rmac::gateway
