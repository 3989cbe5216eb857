#include "gateway/cycle/watch/probe_watch.hpp"

namespace rmac::gateway {

void ProbeWatch::install(bool simulated, const ProbeReport& probe) noexcept {
  simulated_ = simulated;
  measurement_.abandon();
  measurement_.count_from((simulated_ ? simulated_probe_ : probe).hits);
}

void ProbeWatch::simulate(bool touching) noexcept {
  if (touching && !simulated_probe_.touching) ++simulated_probe_.hits;
  simulated_probe_.touching = touching;
}

ProbeWatch::Verdict ProbeWatch::step(const Seen& seen) noexcept {
  if (seen.given_up) measurement_.abandon();
  switch (measurement_.step({seen.moves_left, seen.at_rest, simulated_ ? simulated_probe_ : seen.probe})) {
    case Measurement::Verdict::Nothing:
    case Measurement::Verdict::Done:
      break;
    case Measurement::Verdict::Touched:
      if (measurement_.pending() || seen.positions) return {true, {}};
      return {false, StopCause::HitByHand};  // a move of the queue: what was to follow knows nothing of the part
    case Measurement::Verdict::NotFound:
      return {false, StopCause::PartNotFound};
    case Measurement::Verdict::ProbeLost:
      return {false, StopCause::ProbeLost};
    case Measurement::Verdict::NotArmed:
      return {false, StopCause::ProbeDeflected};
    case Measurement::Verdict::Unexpected:
      return {false, StopCause::UnexpectedHit};
    case Measurement::Verdict::StillTouching:
      return {false, StopCause::ProbeStuck};
  }
  return {};
}

}  // namespace rmac::gateway
