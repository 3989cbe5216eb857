#include "gateway/collision/motion_bound.hpp"

#include <algorithm>
#include <array>

#include "rmac/motion/machine_size.hpp"

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
}

double Posture::radius(const SceneBody& body, std::size_t link) const {
  const LinkChain::Motion& motion = chain_->motion(chain_->joint_behind(link));
  const Vector3d direction(motion.direction[0], motion.direction[1], motion.direction[2]);
  const Vector3d point(motion.point[0], motion.point[1], motion.point[2]);
  const Vector3d middle = links_[link].inverse() * (links_[body.link] * (body.home * body.solid.middle()));
  return direction.cross(middle - point).norm() + body.solid.reach();
}

double Posture::bound(const SceneBody& first, const SceneBody& second, std::span<const double> way) const {
  const bool in_order = first.link < second.link;
  const SceneBody &low = in_order ? first : second, &high = in_order ? second : first;
  // A point of the higher body is also moved by the joints behind the one at hand, and its radius with it; of the lower
  // one by those before.
  std::array<double, kMaxJoints> by_high{};
  double moved = 0;
  for (std::size_t k = high.link; k-- > low.link;) {
    const std::size_t joint = chain_->joint_behind(k);
    const LinkChain::Motion& motion = chain_->motion(joint);
    const double turn = motion.turns * way[joint];
    by_high[k] = motion.slides * way[joint] + (turn > 0 ? turn * (radius(high, k) + moved) : 0);
    moved += by_high[k];
  }
  double total = 0;
  moved = 0;
  for (std::size_t k = low.link; k < high.link; ++k) {
    const std::size_t joint = chain_->joint_behind(k);
    const LinkChain::Motion& motion = chain_->motion(joint);
    const double turn = motion.turns * way[joint];
    const double by_low = motion.slides * way[joint] + (turn > 0 ? turn * (radius(low, k) + moved) : 0);
    moved += by_low;
    total += std::min(by_high[k], by_low);
  }
  return total;
}

}  // namespace rmac::gateway
