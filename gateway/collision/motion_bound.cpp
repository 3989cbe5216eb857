#include "gateway/collision/motion_bound.hpp"

#include <algorithm>

namespace rmac::gateway {

using Eigen::Vector3d;

void Posture::set(std::span<const double> joints) {
  chain_->displace(joints, frames_);
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const auto& [p, q] = frames_[k];
    links_[k].linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    links_[k].translation() = Vector3d(p[0], p[1], p[2]);
    links_[k].makeAffine();
  }
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const LinkChain::Motion& motion = chain_->motion(chain_->joint_behind(k));
    axes_[k].direction = links_[k].linear() * Vector3d(motion.direction[0], motion.direction[1], motion.direction[2]);
    axes_[k].point = links_[k] * Vector3d(motion.point[0], motion.point[1], motion.point[2]);
  }
}

void Posture::radii(const SceneBody& body, Radii& radii) const {
  const Vector3d middle = links_[body.link] * (body.home * body.solid.middle());
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    radii[k] = axes_[k].direction.cross(middle - axes_[k].point).norm() + body.solid.reach();
  }
}

double Posture::bound(const SceneBody& first, const Radii& first_radii, const SceneBody& second,
                      const Radii& second_radii, std::span<const double> way) const {
  const bool in_order = first.link < second.link;
  const Radii &low_radii = in_order ? first_radii : second_radii, &high_radii = in_order ? second_radii : first_radii;
  const SceneBody &low = in_order ? first : second, &high = in_order ? second : first;
  // A point of the higher body is also moved by the joints behind the one at hand, and its radius with it; of the lower
  // one by those before.
  std::array<double, kMaxJoints> by_high;
  double moved = 0;
  for (std::size_t k = high.link; k-- > low.link;) {
    const std::size_t joint = chain_->joint_behind(k);
    const LinkChain::Motion& motion = chain_->motion(joint);
    const double turn = motion.turns * way[joint];
    by_high[k] = motion.slides * way[joint] + turn * (high_radii[k] + moved);
    moved += by_high[k];
  }
  double total = 0;
  moved = 0;
  for (std::size_t k = low.link; k < high.link; ++k) {
    const std::size_t joint = chain_->joint_behind(k);
    const LinkChain::Motion& motion = chain_->motion(joint);
    const double turn = motion.turns * way[joint];
    const double by_low = motion.slides * way[joint] + turn * (low_radii[k] + moved);
    moved += by_low;
    total += std::min(by_high[k], by_low);
  }
  return total;
}

}  // namespace rmac::gateway
