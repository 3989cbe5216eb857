#include "gateway/rmac_cam/hit_finder.hpp"

#include <algorithm>

namespace rmac::gateway {

std::optional<HitFinder::Found> HitFinder::read(const CycleSample& sample) {
  std::shift_left(nodes_.begin(), nodes_.end(), 1);
  nodes_.back() = {sample.t_s, sample.position};
  count_ = std::min(count_ + 1, nodes_.size());
  std::optional<Found> found;
  if (hit_t_s_) found = interpolate(*hit_t_s_, sample.joint_count);
  hit_t_s_.reset();
  if (sample.probe.hits != hits_ && count_ > 1) hit_t_s_ = sample.t_s - sample.probe.hit_before_s;
  hits_ = sample.probe.hits;
  return found;
}

HitFinder::Found HitFinder::interpolate(double t_s, std::size_t joints) const {
  Found found{t_s, std::vector<double>(joints, 0.0)};
  const auto first = nodes_.end() - static_cast<std::ptrdiff_t>(count_);
  for (auto node = first; node != nodes_.end(); ++node) {
    double weight = 1;  // Lagrange's
    for (auto other = first; other != nodes_.end(); ++other) {
      if (other != node) weight *= (t_s - other->t_s) / (node->t_s - other->t_s);
    }
    for (std::size_t j = 0; j < joints; ++j) found.joints[j] += weight * node->position[j];
  }
  return found;
}

}  // namespace rmac::gateway
