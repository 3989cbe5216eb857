#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/collision/scene_body.hpp"

namespace rmac::gateway {

/// Where the links stand, and how far two bodies can move against each other at most while the joints go straight from
/// here to somewhere else. Of a turn this is its angle times the radius on which the farther point of a body runs, seen
/// from whichever of the two it is less (docs/derivations/motion-bound.md).
class Posture {
 public:
  explicit Posture(const LinkChain& chain) : chain_(&chain), frames_(chain.link_count()), links_(chain.link_count()) {}

  void set(std::span<const double> joints);
  [[nodiscard]] Eigen::Isometry3d pose(const SceneBody& body) const { return links_[body.link] * body.home; }

  /// `way`: what each joint goes, all positive.
  [[nodiscard]] double bound(const SceneBody& first, const SceneBody& second, std::span<const double> way) const;

 private:
  /// How far a point of a body may be from the axis of the joint behind a link.
  [[nodiscard]] double radius(const SceneBody& body, std::size_t link) const;

  const LinkChain* chain_;
  std::vector<Frame> frames_;
  std::vector<Eigen::Isometry3d> links_;
};

}  // namespace rmac::gateway
