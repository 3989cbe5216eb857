// The motion supervisor's probe: points that are measured, and hits that nobody asked for.
#include "gateway/cycle/motion_supervisor.hpp"

namespace rmac::gateway {

ProbeReport MotionSupervisor::probe(const ServoStatus& status) const {
  return mechanism_->virtual_mode() ? simulated_probe_ : status.probe;
}

void MotionSupervisor::watch_probe(const CycleObservation& seen, const ServoStatus& status) {
  if (!mechanism_) return;
  if (status.generation != generation_) {
    measurement_.abandon();
    return;
  }
  if (is_faulted(sequencer_.state()) || (sequencer_.state() == CycleState::Stopping && sequencer_.clears_at_rest())) {
    measurement_.abandon();
  }
  const auto stop = [&](StopCause cause) { static_cast<void>(sequencer_.stop_and_clear(cause)); };
  switch (measurement_.step({seen.moves_left, seen.at_rest, probe(status)})) {
    case Measurement::Verdict::Nothing:
    case Measurement::Verdict::Done:
      break;
    case Measurement::Verdict::Touched:
      // By hand a jog is meant: a program that runs meanwhile expects nothing.
      if (measurement_.pending() || sequencer_.positions()) {
        sequencer_.touched();
      } else {
        stop(StopCause::UnexpectedHit);
      }
      break;
    case Measurement::Verdict::NotFound:
      stop(StopCause::PartNotFound);
      break;
    case Measurement::Verdict::ProbeLost:
      stop(StopCause::ProbeLost);
      break;
    case Measurement::Verdict::NotArmed:
      stop(StopCause::ProbeDeflected);
      break;
    case Measurement::Verdict::Unexpected:
      stop(StopCause::UnexpectedHit);
      break;
    case Measurement::Verdict::StillTouching:
      stop(StopCause::ProbeStuck);
      break;
  }
}

Expected<> MotionSupervisor::add_measurement(const std::optional<Move>& approach, const Move& search) {
  if (tools_now().wanted) {
    return failure(
        MinorCode::CommandQueueFull,
        "a point is measured with the tool that is in the spindle, and a tool change is queued; send it when "
        "the tool is changed");
  }
  std::vector<PartOfMove> parts;
  if (approach) parts.push_back({&*approach, {.first = true, .last = false}});
  parts.push_back({&search, {.first = !approach, .last = false}});
  return build_and_add(parts, [this](std::size_t moving) { measurement_.begin(moving); }).map([](std::size_t) {});
}

Expected<> MotionSupervisor::add_retract(const Move& move) {
  {
    const Turn turn(*this);
    notice_fault();
    if (measurement_.phase() != Measurement::Phase::Standing) return {};
    if (auto ready = ready_for_move(); !ready) return ready;
  }
  return build_and_add({{&move, {.first = false, .last = true}}}, [this](std::size_t) { measurement_.retract(); })
      .map([](std::size_t) {});
}

Measurement::Phase MotionSupervisor::measurement() {
  const Turn turn(*this);
  return measurement_.phase();
}

void MotionSupervisor::expect_hits_by_hand(bool expected) {
  const Turn turn(*this);
  measurement_.expect_by_hand(expected);
}

void MotionSupervisor::simulate_probe(bool touching) {
  const Turn turn(*this);
  if (touching && !simulated_probe_.touching) ++simulated_probe_.hits;
  simulated_probe_.touching = touching;
}

}  // namespace rmac::gateway
