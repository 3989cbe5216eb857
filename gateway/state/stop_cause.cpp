#include "gateway/state/stop_cause.hpp"

namespace rmac::gateway {

const char* describe(StopCause cause) noexcept {
  switch (cause) {
    case StopCause::CycleStop:
      return "the machine has come to rest after a CycleStop; what is queued goes on with CycleStart";
    case StopCause::CycleEnded:
      return "the cycle has ended: all that was queued is done";
    case StopCause::StopNow:
      return "the machine has come to rest after a StopNow, or because motion authority was given back or lost; its "
             "queue is empty";
    case StopCause::JogLapsed:
      return "the jog came to rest because it was not renewed in time: its key, its client or the network let go; jog "
             "again to go on";
    case StopCause::JogEnded:
      return "the jog has come to rest, as its client asked";
    case StopCause::MoveDone:
      return "the machine has come to rest: the one move that was to be done is done";
    case StopCause::Homed:
      return "the drives have found home, and the machine stands there";
    case StopCause::HitByHand:
      return "the probe touched, as ManualMeasure expects, and the machine has come to rest with an empty queue; jog "
             "or move on";
    case StopCause::UnexpectedHit:
      return "the probe touched where nothing was expected, and the machine was stopped; its queue is empty. Look "
             "what is in the way, and jog off it";
    case StopCause::PartNotFound:
      return "the search ended without a hit, so the part is not where it was looked for; the queue is empty. Look "
             "where the part is, or give a longer search distance";
    case StopCause::ProbeLost:
      return "the probe lost its power during a search, and the machine was stopped; its queue is empty. Switch it on";
    case StopCause::ProbeDeflected:
      return "the probe was deflected before it could touch the part, and the machine was stopped; its queue is empty. "
             "Look what holds it, and jog it free";
    case StopCause::ProbeStuck:
      return "the probe still touches after its way back, and the machine was stopped; its queue is empty. Jog it "
             "free, or give a longer retract distance";
    case StopCause::AirLost:
      return "the compressed air went off (input Air), and the machine was stopped on its path; see to the air, then "
             "go "
             "on with CycleStart";
    case StopCause::Parked:
      return "the program is parked, and the queue is empty; TakeUpProgram queues it again from its place";
    case StopCause::RetraceEnded:
      return "the machine has come to rest at the end of its way back; FeedResume goes forward again";
  }
  return "the machine has come to rest";
}

MinorCode code_of(StopCause cause) noexcept {
  switch (cause) {
    case StopCause::UnexpectedHit:
      return MinorCode::UnexpectedHit;
    case StopCause::PartNotFound:
      return MinorCode::PartNotFound;
    case StopCause::AirLost:
      return MinorCode::NoAir;
    case StopCause::ProbeLost:
    case StopCause::ProbeDeflected:
    case StopCause::ProbeStuck:
      return MinorCode::ProbeNotArmed;
    default:
      return MinorCode::None;
  }
}

}  // namespace rmac::gateway
