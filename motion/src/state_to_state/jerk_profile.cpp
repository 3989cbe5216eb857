#include <algorithm>
#include <cmath>

#include "rmac/motion/state_to_state.hpp"

namespace rmac {
namespace {

JointState after(const JointState& from, double jerk, double t) noexcept {
  return {from.position + t * (from.velocity + t * (from.acceleration / 2 + t * jerk / 6)),
          from.velocity + t * (from.acceleration + t * jerk / 2), from.acceleration + t * jerk};
}

}  // namespace

JerkProfile::JerkProfile(const JointState& from) noexcept : peak_(std::abs(from.acceleration)), end_(from) {}

void JerkProfile::append(double duration, double jerk) noexcept {
  if (!(duration > 0) || count_ == kMaxPhases) return;
  // A cruise may last for hours: what rounding left of the acceleration before it must not add up.
  constexpr double kRounding = 1e-12;
  if (jerk == 0 && std::abs(end_.acceleration) <= kRounding * peak_) end_.acceleration = 0;
  phases_[count_++] = {duration_, end_, jerk};
  end_ = after(end_, jerk, duration);
  peak_ = std::max(peak_, std::abs(end_.acceleration));
  duration_ += duration;
}

JointState JerkProfile::at(double t) const noexcept {
  if (t >= duration_ || count_ == 0) return end_;
  std::size_t i = count_ - 1;
  while (i > 0 && phases_[i].t0 > t) --i;
  return after(phases_[i].start, phases_[i].jerk, std::max(t - phases_[i].t0, 0.0));
}

}  // namespace rmac
