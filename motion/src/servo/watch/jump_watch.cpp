#include "servo/watch/jump_watch.hpp"

#include <cmath>
#include <utility>

namespace rmac {

void JumpWatch::raise(double jump, FaultSink& faults) const noexcept {
  faults.raise({ServoFault::Kind::EncoderJump, ServoFault::Part::Joint, index_, jump, joint_->bounds.jump});
}

void JumpWatch::step(const JumpSeen& seen, FaultSink& faults) noexcept {
  const double bound = joint_->bounds.jump;
  if (!(bound > 0)) return;
  const bool steady = std::exchange(steady_, std::abs(seen.jump) <= bound / 2);
  // With all its effort a motor may do to a spring what it cannot do to its joint.
  constexpr double kTrembles = 4;
  if (seen.trembles && std::abs(seen.jump) <= kTrembles * bound) return suspicion_.reset();
  if (suspicion_) {
    if (seen.step) look_again(*seen.step, faults);
    return;
  }
  if (std::abs(seen.jump) <= bound) return;
  if (!seen.may_stop) return raise(seen.jump, faults);
  constexpr int kSteps = 2;  // more, and it may be a motor that swings on its screw
  if (steady && seen.step) suspicion_ = {seen.jump, *seen.step - seen.jump, kSteps};
}

// What stopped stays so, or swings back further; what slips on stays so, too, and then goes on as before.
void JumpWatch::look_again(double step, FaultSink& faults) noexcept {
  const double change = step - suspicion_->step_before, half = std::abs(suspicion_->jump) / 2;
  if (std::abs(change) < half) {
    raise(suspicion_->jump, faults);
    suspicion_.reset();
  } else if (std::abs(change - suspicion_->jump) >= half || --suspicion_->steps_left == 0) {
    suspicion_.reset();
  }
}

}  // namespace rmac
