#include "gateway/rmac_cam/measuring/hit_finder.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

/// A drive that has not told its position by then has not latched it.
constexpr int kPatience = 10;

}  // namespace

std::optional<HitFinder::Found> HitFinder::read(const CycleSample& sample) {
  std::shift_left(nodes_.begin(), nodes_.end(), 1);
  nodes_.back() = {sample.t_s, sample.position};
  count_ = std::min(count_ + 1, nodes_.size());
  std::optional<Found> found;
  const bool another = sample.probe.hits != hits_;
  if (hit_) {
    if (++hit_->samples == 1) hit_->around.assign(nodes_.end() - static_cast<std::ptrdiff_t>(count_), nodes_.end());
    const bool told = (hit_->latching & ~sample.probe.latched) == 0;
    if (told || hit_->samples > kPatience || another) {
      found = find(*hit_, sample);
      hit_.reset();
    }
  }
  if (another && count_ > 1) {
    hit_ = Hit{.t_s = sample.t_s - sample.probe.hit_before_s,
               .stamped = sample.probe.hit_before_s > 0,
               .latching = sample.probe.latching,
               .samples = 0,
               .around = {}};
  }
  hits_ = sample.probe.hits;
  return found;
}

HitFinder::Found HitFinder::find(const Hit& hit, const CycleSample& sample) {
  const ProbeReport& probe = sample.probe;
  const std::uint32_t latched = hit.latching & probe.latched;
  // The fastest of the joints whose place is known says when that was.
  std::size_t fastest = sample.joint_count;
  double way = 0;
  for (std::size_t j = 0; j < sample.joint_count; ++j) {
    const double went = std::abs(hit.around.back().position[j] - hit.around.front().position[j]);
    if ((latched >> j & 1U) == 0 || went <= way) continue;
    fastest = j;
    way = went;
  }
  Found found{hit.t_s, {}};
  if (!hit.stamped && fastest < sample.joint_count) {
    found.t_s = passing(hit.around, fastest, probe.latched_position[fastest], hit.t_s);
  }
  found.joints = interpolate(hit.around, found.t_s, sample.joint_count);
  for (std::size_t j = 0; j < sample.joint_count; ++j) {
    if ((latched >> j & 1U) != 0) found.joints[j] = probe.latched_position[j];
  }
  return found;
}

/// When `joint` was at `position`; `t_s` where it was not, within the nodes.
double HitFinder::passing(const std::vector<Node>& nodes, std::size_t joint, double position, double t_s) {
  const auto beyond = [&](double at_s) { return interpolate(nodes, at_s, joint + 1)[joint] - position; };
  double before = nodes.front().t_s, after = nodes.back().t_s;
  const double first = beyond(before);
  if (first * beyond(after) > 0) return t_s;
  for (int i = 0; i < 40; ++i) {
    const double middle = (before + after) / 2;
    (beyond(middle) * first > 0 ? before : after) = middle;
  }
  return (before + after) / 2;
}

std::vector<double> HitFinder::interpolate(const std::vector<Node>& nodes, double t_s, std::size_t joints) {
  std::vector<double> found(joints, 0.0);
  for (const Node& node : nodes) {
    double weight = 1;  // Lagrange's
    for (const Node& other : nodes) {
      if (&other != &node) weight *= (t_s - other.t_s) / (node.t_s - other.t_s);
    }
    for (std::size_t j = 0; j < joints; ++j) found[j] += weight * node.position[j];
  }
  return found;
}

}  // namespace rmac::gateway
