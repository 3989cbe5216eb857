#include "gateway/rmac_cam/measuring/hit_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
    const std::size_t late = *std::max_element(sample.answer_delay.begin(), sample.answer_delay.end());
    const auto kept = static_cast<std::ptrdiff_t>(std::min(count_, kNodes + late));
    const bool seen = std::cmp_greater(++hit_->samples, late) || another;
    if (seen && hit_->around.empty()) hit_->around.assign(nodes_.end() - kept, nodes_.end());
    const bool told = seen && (hit_->latching & ~sample.probe.latched) == 0;
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
    found.t_s = passing(hit.around, fastest, sample.answer_delay[fastest], probe.latched_position[fastest], hit.t_s);
  }
  for (std::size_t j = 0; j < sample.joint_count; ++j) {
    const bool is_known = (latched >> j & 1U) != 0;
    found.joints.push_back(is_known ? probe.latched_position[j]
                                    : joint_at(hit.around, j, sample.answer_delay[j], found.t_s));
  }
  return found;
}

/// When `joint` was at `position`; `t_s` where it was not, within the nodes.
double HitFinder::passing(const std::vector<Node>& around, std::size_t joint, std::size_t delay, double position,
                          double t_s) {
  const auto beyond = [&](double at_s) { return joint_at(around, joint, delay, at_s) - position; };
  double before = around.front().t_s, after = around[std::min(around.size(), kNodes) - 1].t_s;
  const double first = beyond(before);
  if (first * beyond(after) > 0) return t_s;
  for (int i = 0; i < 40; ++i) {
    const double middle = (before + after) / 2;
    (beyond(middle) * first > 0 ? before : after) = middle;
  }
  return (before + after) / 2;
}

/// Where `joint` was, whose place in a cycle was told `delay` cycles later.
double HitFinder::joint_at(const std::vector<Node>& around, std::size_t joint, std::size_t delay, double t_s) {
  const std::size_t count = std::clamp<std::size_t>(around.size() - std::min(delay, around.size()), 1, kNodes);
  double found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double weight = 1;  // Lagrange's
    for (std::size_t other = 0; other < count; ++other) {
      if (other != i) weight *= (t_s - around[other].t_s) / (around[i].t_s - around[other].t_s);
    }
    found += weight * around[std::min(i + delay, around.size() - 1)].position[joint];
  }
  return found;
}

}  // namespace rmac::gateway
