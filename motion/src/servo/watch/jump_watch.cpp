#include "servo/watch/jump_watch.hpp"

#include <cmath>
#include <utility>

namespace rmac {

void JumpWatch::raise(double jump, FaultSink& faults) noexcept {
  suspicion_.reset();
  jumped_ = true;
  faults.raise({ServoFault::Kind::EncoderJump, ServoFault::Part::Joint, index_, jump, joint_->bounds.jump});
}

void JumpWatch::step(const JumpSeen& seen, FaultSink& faults) noexcept {
  const double bound = joint_->bounds.jump;
  if (!(bound > 0)) return;
  const bool steady = std::exchange(steady_, std::abs(seen.jump) <= bound / 2);
  const bool jumps = std::abs(seen.jump) > bound;
  // A motor that swings may do to its spring what it cannot do to its joint; while it swings more and more, it is
  // faster each time.
  constexpr double kTrembles = 4;
  const bool swung = (seen.shakes || (seen.trembles && seen.may_stop)) && std::abs(seen.jump) <= kTrembles * bound;
  if (seen.refused || (jumps && !seen.may_stop && !swung)) return raise(seen.jump, faults);
  if (swung) return suspicion_.reset();
  if (suspicion_) {
    if (seen.step) look_again(*seen.step, faults);
    return;
  }
  constexpr int kSteps = 2;  // more, and it may be a motor that swings on its screw
  if (jumps && steady && seen.step) suspicion_ = {seen.jump, *seen.step - seen.jump, kSteps};
}

// What stopped stays so, or swings back further; what slips on stays so, too, and then goes on as before.
void JumpWatch::look_again(double step, FaultSink& faults) noexcept {
  const double change = step - suspicion_->step_before, half = std::abs(suspicion_->jump) / 2;
  if (std::abs(change) < half) {
    raise(suspicion_->jump, faults);
  } else if (std::abs(change - suspicion_->jump) >= half || --suspicion_->steps_left == 0) {
    suspicion_.reset();
  }
}

}  // namespace rmac
