#include "gateway/cycle/cycle_sequencer.hpp"

#include <fmt/format.h>

namespace rmac::gateway {

const char* describe(StopCause cause) noexcept {
  switch (cause) {
    case StopCause::CycleStop:
      return "the machine has come to rest after a CycleStop; what is queued goes on with CycleStart";
    case StopCause::StopNow:
      return "the machine has come to rest after a StopNow, or because motion authority was lost; its queue is empty";
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
      return "the probe touched, and the machine has come to rest; jog on";
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

Expected<> CycleSequencer::refuse_when_faulted(const char* what) const {
  if (state_ == CycleState::EmergencyStop) {
    return failure(MinorCode::EmergencyStop,
                   fmt::format("{}: the machine is in emergency stop; release it, then reset", what));
  }
  if (state_ == CycleState::Faulted) {
    return failure(MinorCode::Other, fmt::format("{}: the machine is faulted; remove the cause, then reset", what));
  }
  return {};
}

Expected<> CycleSequencer::refuse_when_unfit(const char* what, const CycleObservation& seen) const {
  if (auto fine = refuse_when_faulted(what); !fine) return fine;
  if (seen.air) return {};
  return failure(MinorCode::NoAir, fmt::format("{}: the machine has no compressed air (input Air is off); see to it, "
                                               "then start again",
                                               what));
}

Expected<> CycleSequencer::start(sdk::CycleMode mode, const CycleObservation& seen) {
  if (auto fine = refuse_when_unfit("CycleStart", seen); !fine) return fine;
  if (state_ == CycleState::Stopping) {
    return failure(MinorCode::Other, "CycleStart: the machine is still stopping; start it when it has come to rest");
  }
  if (state_ == CycleState::Running && positioning_) {
    return failure(MinorCode::Other, "CycleStart: a jog is under way; start the cycle when it has ended");
  }
  if (retracing_) {
    return failure(MinorCode::Other,
                   "CycleStart: the machine runs back along its path; FeedResume turns it forward, FeedHold stops it");
  }
  if (state_ == CycleState::Running && mode == mode_) return {};
  mode_ = mode;
  positioning_ = false;
  state_ = CycleState::Running;
  done_at_start_ = seen.moves_done;
  one_done_ = false;
  waiting_since_s_.reset();
  return {};
}

Expected<> CycleSequencer::check_positioning(const CycleObservation& seen) const {
  if (auto fine = refuse_when_unfit("jog", seen); !fine) return fine;
  if (positioning_)
    return failure(MinorCode::Other,
                   "jog: another jog is under way or coming to rest; jog again when the machine stands");
  if (state_ != CycleState::Idle) {
    return failure(MinorCode::Other,
                   fmt::format("jog: the machine is {}, a jog needs it Idle; stop the cycle first", to_string(state_)));
  }
  return {};
}

Expected<> CycleSequencer::start_positioning(const CycleObservation& seen, std::optional<double> lasts_s) {
  if (auto fine = check_positioning(seen); !fine) return fine;
  jog_until_s_.reset();
  if (lasts_s) renew_jog(seen, *lasts_s);
  mode_ = sdk::CycleMode::Manual;
  positioning_ = true;
  state_ = CycleState::Running;
  done_at_start_ = seen.moves_done;
  one_done_ = false;
  return {};
}

Expected<> CycleSequencer::start_homing(const CycleObservation& seen) {
  if (auto started = start_positioning(seen, std::nullopt); !started) return started;
  homing_ = true;
  homings_before_ = seen.homings;
  return {};
}

Expected<> CycleSequencer::check_retrace(const CycleObservation& seen) const {
  if (auto fine = refuse_when_faulted("FeedRetrace"); !fine) return fine;
  if (state_ != CycleState::Holding) {
    return failure(MinorCode::Other, fmt::format("FeedRetrace: the machine is {}, and only what is held can be "
                                                 "retraced; send FeedHold first",
                                                 to_string(state_)));
  }
  if (positioning_) {
    return failure(MinorCode::Other, "FeedRetrace: a jog is held, not a program; jog back instead");
  }
  if (!seen.at_rest) {
    return failure(MinorCode::Other, "FeedRetrace: the machine is still coming to rest; ask again when it stands");
  }
  return {};
}

void CycleSequencer::retrace() noexcept {
  retracing_ = true;
  state_ = CycleState::Running;
}

Expected<> CycleSequencer::stop() {
  // What is left of a jog is no part of a program: it must not run at the next start.
  clear_at_rest_ = clear_at_rest_ || positioning_;
  if (state_ == CycleState::Running || state_ == CycleState::Holding) {
    stop_cause_ = positioning_ ? StopCause::JogEnded : StopCause::CycleStop;
    state_ = CycleState::Stopping;
  }
  return {};
}

Expected<> CycleSequencer::stop_and_clear(StopCause cause) {
  if (is_faulted(state_)) return {};
  clear_at_rest_ = true;
  stop_cause_ = cause;
  state_ = CycleState::Stopping;
  return {};
}

void CycleSequencer::touched() noexcept {
  if (is_faulted(state_)) return;
  if (!positioning_) {
    ends_search_ = true;
    return;
  }
  static_cast<void>(stop());
  stop_cause_ = StopCause::HitByHand;
}

Expected<> CycleSequencer::hold() {
  if (homing_) return stop();  // there is no path to go on with
  if (state_ == CycleState::Running) state_ = CycleState::Holding;
  return {};
}

void CycleSequencer::take_up(sdk::CycleMode mode, const CycleObservation& seen) noexcept {
  mode_ = mode;
  state_ = CycleState::Holding;
  done_at_start_ = seen.moves_done;
  one_done_ = false;
}

Expected<> CycleSequencer::resume() {
  if (auto fine = refuse_when_faulted("FeedResume"); !fine) return fine;
  retracing_ = false;
  if (state_ == CycleState::Running) return {};
  if (state_ != CycleState::Holding) {
    return failure(MinorCode::Other, fmt::format("FeedResume: nothing is held, the machine is {}; CycleStart runs the "
                                                 "queue",
                                                 to_string(state_)));
  }
  state_ = CycleState::Running;
  return {};
}

Expected<> CycleSequencer::reset() {
  if (!is_faulted(state_)) {
    return failure(MinorCode::Other,
                   fmt::format("reset: there is no fault to reset, the machine is {}", to_string(state_)));
  }
  state_ = CycleState::Idle;
  clear_at_rest_ = false;
  spindle_wait_ = false;
  commanded_ = PathCommand::Stop;
  return {};
}

void CycleSequencer::fault(CycleState to) noexcept {
  if (state_ != CycleState::EmergencyStop) state_ = to;
  clear_at_rest_ = ends_search_ = false;
}

void CycleSequencer::mechanism_changed(bool keep_running) noexcept {
  if (!keep_running) {
    // A fault is left by a reset, not by taking the mechanism out.
    if (!is_faulted(state_)) state_ = CycleState::Idle;
    clear_at_rest_ = false;  // a stop may come while mechanisms change; the new one's queue is empty
    spindle_wait_ = false;
  }
  done_at_start_ = 0;
  ends_search_ = false;
  commanded_ = PathCommand::Stop;
}

void CycleSequencer::spindle_commanded(double timeout_s) noexcept {
  spindle_wait_ = true;
  spindle_timeout_s_ = timeout_s;
  waiting_since_s_.reset();
}

PathCommand CycleSequencer::wanted(const CycleObservation& seen) noexcept {
  if (state_ != CycleState::Running || homing_ || ends_search_) return PathCommand::Stop;
  // Motion under way is not interrupted by a spindle command: it began with the speed it needed.
  if (spindle_wait_ && !positioning_ && seen.at_rest) return PathCommand::Stop;
  if (retracing_) return PathCommand::Retrace;
  if (mode_ == sdk::CycleMode::Automatic || seen.measures) return PathCommand::Run;
  // The planner takes the move that is next when it is told: there must be one.
  return seen.moves_left > 0 ? PathCommand::RunOne : PathCommand::Stop;
}

CycleSequencer::Verdict CycleSequencer::step(const CycleObservation& seen) noexcept {
  Verdict verdict;
  if (seen.faulted) fault(seen.emergency_stop ? CycleState::EmergencyStop : CycleState::Faulted);
  if (state_ == CycleState::Running && !seen.air) {
    static_cast<void>(stop());
    stop_cause_ = StopCause::AirLost;
  }
  if (state_ == CycleState::Running && jog_until_s_ && seen.t_s > *jog_until_s_) {
    static_cast<void>(stop());
    stop_cause_ = StopCause::JogLapsed;
  }
  if (state_ == CycleState::Stopping && seen.at_rest) {
    state_ = CycleState::Idle;
    verdict.clear_queue = clear_at_rest_;
    verdict.came_to_rest = stop_cause_;
    clear_at_rest_ = false;
  }
  if (ends_search_ && seen.at_rest) {
    ends_search_ = false;
    verdict.clear_queue = true;
  }
  if (state_ == CycleState::Running && retracing_ && seen.retraced) {
    state_ = CycleState::Holding;
    verdict.came_to_rest = StopCause::RetraceEnded;
  }
  if (homing_ && state_ == CycleState::Running && seen.follows && seen.homings != homings_before_) {
    state_ = CycleState::Idle;
    verdict.came_to_rest = StopCause::Homed;
  }
  if (state_ != CycleState::Running) retracing_ = homing_ = false;
  if (state_ == CycleState::Running && !retracing_ && mode_ == sdk::CycleMode::Manual && seen.at_rest &&
      !seen.measures && (one_done_ || seen.moves_done > done_at_start_)) {
    state_ = CycleState::Idle;
    positioning_ = false;
    verdict.came_to_rest = StopCause::MoveDone;
  }
  if (spindle_wait_ && seen.spindles_at_speed) spindle_wait_ = false;
  // Only what waits for the spindle can wait too long: motion under way began with the speed it needed.
  if (spindle_wait_ && state_ == CycleState::Running && !positioning_ && seen.at_rest) {
    if (!waiting_since_s_) waiting_since_s_ = seen.t_s;
    if (seen.t_s - *waiting_since_s_ > spindle_timeout_s_) {
      fault();
      spindle_wait_ = false;
      verdict.spindle_timed_out = true;
    }
  }
  if (state_ == CycleState::Idle) positioning_ = false;
  if (!positioning_) jog_until_s_.reset();
  if (const PathCommand command = wanted(seen); command != commanded_) {
    commanded_ = command;
    verdict.command = command;
  }
  return verdict;
}

}  // namespace rmac::gateway
