#include "servo/learned/learned_offsets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rmac {

LearnedOffsets::LearnedOffsets(std::span<const ServoJoint> joints, double period_s)
    : parts_(joints), period_s_(period_s) {
  for (const ServoJoint& joint : joints) joints_.push_back({.bound = bound(joint, false)});
}

void LearnedOffsets::step(const Setpoint& at, bool follows, IndexSet controlled) noexcept {
  std::array<double, kMaxJoints> learned{};
  const bool known = follows && path_ != nullptr && path_->at(cursor_, at.move_id, at.s_mm, learned);
  if (!known) cursor_ = {};
  const bool turns = known != std::exchange(followed_, known);
  // Where a cycle goes by more than a knot, a change is taken for a jump, too: it fades in.
  const double most = path_ == nullptr ? 0 : path_->steepest();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    if (!has(controlled, j)) {
      joint = {.bound = joint.bound};
      continue;
    }
    const bool takes = known && parts_[j].method == ControlMethod::Position;
    const double wanted = takes ? std::clamp(learned[j], -joint.bound, joint.bound) : 0;
    go_on(joint, wanted, turns || std::abs(wanted - joint.wanted) > most);
  }
}

void LearnedOffsets::go_on(Joint& joint, double wanted, bool jumps) const noexcept {
  if (jumps) {
    joint.rest = joint.offset - wanted;
    joint.rest_rate = joint.rate;
  }
  joint.wanted = wanted;
  joint.rest_rate -= period_s_ * kFading * (2 * joint.rest_rate + kFading * joint.rest);
  joint.rest += period_s_ * joint.rest_rate;
  // What fades would end in denormal numbers, which are slow.
  if (std::abs(joint.rest) < kFaded && std::abs(joint.rest_rate) < kFaded) joint.rest = joint.rest_rate = 0;
  const double before = joint.offset;
  const double step = joint.bound * kFastest * period_s_;
  joint.offset = std::clamp(wanted + joint.rest, before - step, before + step);
  joint.offset = std::clamp(joint.offset, -joint.bound, joint.bound);
  joint.rate = (joint.offset - before) / period_s_;
}

}  // namespace rmac
