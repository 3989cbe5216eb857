#include "gateway/cycle/states/cycle_sequencer.hpp"

#include <fmt/format.h>

#include <bit>

#include "gateway/mechanism/joint_name.hpp"

namespace rmac::gateway {
namespace {

using Phase = CyclePhase;

Expected<> refuse_when_faulted(const char* what, const Phase& phase) {
  const Phase::Faulted* const faulted = phase.in<Phase::Faulted>();
  if (faulted == nullptr) return {};
  if (faulted->emergency_stop) {
    return failure(MinorCode::EmergencyStop,
                   fmt::format("{}: the machine is in emergency stop; release it, then reset", what));
  }
  return failure(MinorCode::Other, fmt::format("{}: the machine is faulted; remove the cause, then reset", what));
}

/// Also where the machine lacks what it needs to move.
Expected<> refuse_when_unfit(const char* what, const Phase& phase, const CycleObservation& seen) {
  if (auto fine = refuse_when_faulted(what, phase); !fine) return fine;
  if (seen.air) return {};
  return failure(MinorCode::NoAir, fmt::format("{}: the machine has no compressed air (input Air is off); see to it, "
                                               "then start again",
                                               what));
}

}  // namespace

Expected<> require_references(const char* what, std::uint32_t lost, const sdk::DeviceObject* device) {
  if (lost == 0) return {};
  return failure(
      MinorCode::Scale,
      fmt::format("{}: {} has lost its reference, because its position jumped or was not where the machine was "
                  "left; find it again (rmac home), or, where its drive does not look for home, see that it stands "
                  "where rmac status says, and unload and load the machine",
                  what, joint_name(static_cast<std::size_t>(std::countr_zero(lost)), device)));
}

Expected<> refuse_when_held(const char* what, const OperatorRef& by) {
  if (!by) return {};
  return failure(
      MinorCode::Other,
      by->present()
          ? fmt::format("{}: {}, who is the operator, holds the machine; resume there", what, by->name())
          : fmt::format("{}: {}, who was the operator and has left, holds the machine; resume as the next operator "
                        "(operator.acquire, then FeedResume; rmac resume), or take the hold over with Reset",
                        what, by->name()));
}

Expected<> refuse_when_blocked(const char* what, const CycleObservation& seen) {
  if (!seen.blocked) return {};
  return failure(
      MinorCode::Other,
      fmt::format("{}: a collision lies ahead, which the event CollisionAhead has told; go back from there with "
                  "FeedRetrace, or drop the program with StopNow",
                  what));
}

bool waits_for_moves(const Phase& phase, const CycleObservation& seen) noexcept {
  return phase.runs<Phase::Program>() && seen.at_rest && seen.done && !seen.measures && !phase.ends_search();
}

Expected<> CycleSequencer::start(sdk::CycleMode mode, const CycleObservation& seen) {
  if (auto fine = refuse_when_unfit("CycleStart", phase_, seen); !fine) return fine;
  if (auto free = refuse_when_held("CycleStart", phase_.held_by()); !free) return free;
  if (auto clear = refuse_when_blocked("CycleStart", seen); !clear) return clear;
  if (auto known = require_references("CycleStart", seen.reference_lost, seen.device); !known) return known;
  if (phase_.in<Phase::Stopping>()) {
    return failure(MinorCode::Other, "CycleStart: the machine is still stopping; start it when it has come to rest");
  }
  if (phase_.positions()) {
    return failure(MinorCode::Other,
                   phase_.in<Phase::Holding>()
                       ? "CycleStart: a jog is held, no program; FeedResume goes on with it, CycleStop drops it"
                       : "CycleStart: a jog is under way; start the cycle when it has ended");
  }
  if (phase_.runs<Phase::Retrace>()) {
    return failure(MinorCode::Other,
                   "CycleStart: the machine runs back along its path; FeedResume turns it forward, FeedHold stops it");
  }
  if (phase_.in<Phase::Running>() && mode == mode_) return {};
  mode_ = mode;
  phase_.run_program();
  count_from(seen);
  spindle_wait_.restart();
  return {};
}

Expected<> CycleSequencer::check_positioning(const CycleObservation& seen) const {
  if (auto fine = refuse_when_unfit("jog", phase_, seen); !fine) return fine;
  if (phase_.positions()) {
    return failure(MinorCode::Other,
                   "jog: another jog is under way or coming to rest; jog again when the machine stands");
  }
  if (auto free = refuse_when_held("jog", phase_.held_by()); !free) return free;
  if (waits_for_moves(phase_, seen)) {
    if (jog_while_waiting_) return {};
    return failure(MinorCode::Other,
                   "jog: CycleStart was sent, and the cycle waits for moves with nothing queued; end it with CycleStop "
                   "(rmac stop), then jog, or let a jog end it with jog_while_waiting in rmacd.json");
  }
  if (!phase_.in<Phase::Idle>()) {
    return failure(MinorCode::Other, fmt::format("jog: the machine is {}, a jog needs it Idle; stop the cycle first",
                                                 to_string(state())));
  }
  return {};
}

Expected<> CycleSequencer::start_positioning(const CycleObservation& seen, std::optional<double> lasts_s) {
  if (auto fine = check_positioning(seen); !fine) return fine;
  mode_ = sdk::CycleMode::Manual;
  phase_.run(Phase::Positioning{});
  if (lasts_s) phase_.run(Phase::Jog{seen.t_s + *lasts_s});
  count_from(seen);
  return {};
}

void CycleSequencer::renew_jog(const CycleObservation& seen, double lasts_s) noexcept {
  if (phase_.jogs()) phase_.run(Phase::Jog{seen.t_s + lasts_s});
}

Expected<> CycleSequencer::start_homing(const CycleObservation& seen) {
  return start_positioning(seen, std::nullopt).map([&] { phase_.run(Phase::Homing{seen.homings}); });
}

Expected<> CycleSequencer::check_retrace(const CycleObservation& seen, const OperatorRef& by) const {
  if (auto fine = refuse_when_faulted("FeedRetrace", phase_); !fine) return fine;
  if (auto free = by ? Expected<>{} : refuse_when_held("FeedRetrace", phase_.held_by()); !free) return free;
  if (!phase_.in<Phase::Holding>()) {
    return failure(MinorCode::Other, fmt::format("FeedRetrace: the machine is {}, and only what is held can be "
                                                 "retraced; send FeedHold first",
                                                 to_string(state())));
  }
  if (phase_.positions()) {
    return failure(MinorCode::Other, "FeedRetrace: a jog is held, not a program; jog back instead");
  }
  if (!seen.at_rest || phase_.ends_search()) {
    return failure(MinorCode::Other, "FeedRetrace: the machine is still coming to rest; ask again when it stands");
  }
  return {};
}

Expected<> CycleSequencer::stop() {
  phase_.stop(phase_.positions() ? StopCause::JogEnded : StopCause::CycleStop);
  return {};
}

void CycleSequencer::retrace(const OperatorRef& by) noexcept {
  phase_.run(Phase::Retrace{by ? by : phase_.held_by()});
}

Expected<> CycleSequencer::stop_and_clear(const CycleObservation& seen, StopCause cause) {
  // A move that ends at rest is done some cycles before rest is seen: nothing is cut short even then.
  const bool program = phase_.runs<Phase::Program>() != nullptr || phase_.holds<Phase::Program>() != nullptr;
  const bool over = program && seen.done && seen.moves_left == 0 && !seen.measures;
  phase_.stop_and_clear(cause == StopCause::StopNow && over ? StopCause::CycleEnded : cause);
  return {};
}

Expected<> CycleSequencer::hold(const OperatorRef& by) {
  if (by) {
    phase_.hold_for(by);
  } else {
    phase_.hold();
  }
  return {};
}

void CycleSequencer::take_up(sdk::CycleMode mode, const CycleObservation& seen) noexcept {
  mode_ = mode;
  phase_.hold_program();
  count_from(seen);
}

Expected<> CycleSequencer::resume(const OperatorRef& by) {
  if (auto fine = refuse_when_faulted("FeedResume", phase_); !fine) return fine;
  if (auto free = by ? Expected<>{} : refuse_when_held("FeedResume", phase_.held_by()); !free) return free;
  const bool let_go = phase_.let_go();
  if (phase_.runs<Phase::Retrace>()) phase_.run(Phase::Program{});
  if (phase_.in<Phase::Running>() || phase_.in<Phase::Holding>()) {
    phase_.resume();
    return {};
  }
  if (let_go) return {};
  return failure(MinorCode::Other, fmt::format("FeedResume: nothing is held, the machine is {}; CycleStart runs the "
                                               "queue",
                                               to_string(state())));
}

Expected<> CycleSequencer::reset() {
  if (!phase_.in<Phase::Faulted>()) {
    return failure(MinorCode::Other,
                   fmt::format("reset: there is no fault to reset, the machine is {}", to_string(state())));
  }
  phase_.rest();
  spindle_wait_.end();
  commanded_ = PathCommand::Stop;
  return {};
}

void CycleSequencer::mechanism_changed(bool keep_running) noexcept {
  if (!keep_running) {
    // A fault is left by a reset, not by taking the mechanism out. A stop may come while mechanisms change; the new
    // one's queue is empty.
    if (!phase_.in<Phase::Faulted>()) phase_.rest();
    spindle_wait_.end();
  }
  phase_.forget_search();
  one_move_.done_before = 0;
  commanded_ = PathCommand::Stop;
}

PathCommand CycleSequencer::wanted(const CycleObservation& seen) const noexcept {
  if (!phase_.in<Phase::Running>() || phase_.homes() || phase_.ends_search()) return PathCommand::Stop;
  // Motion under way is not interrupted by a spindle command: it began with the speed it needed.
  if (waits_for_spindle() && !phase_.positions() && seen.at_rest) return PathCommand::Stop;
  if (phase_.runs<Phase::Retrace>()) return PathCommand::Retrace;
  if (mode_ == sdk::CycleMode::Automatic || seen.measures) return PathCommand::Run;
  // The planner takes the move that is next when it is told: there must be one, or the way to where the last one ended.
  return seen.moves_left > 0 || !seen.at_end ? PathCommand::RunOne : PathCommand::Stop;
}

void CycleSequencer::end_what_is_done(const CycleObservation& seen, Verdict& verdict) noexcept {
  if (const Phase::Stopping* const stopping = phase_.in<Phase::Stopping>(); stopping && seen.at_rest) {
    verdict.clear_queue = stopping->end != Phase::StopEnd::KeepQueue;
    verdict.came_to_rest = stopping->cause;
    phase_.rest();
  }
  if (phase_.ends_search() && seen.at_rest) {
    phase_.forget_search();
    verdict.clear_queue = true;
  }
  if (phase_.runs<Phase::Retrace>()) {
    if (!seen.retraced) return;
    phase_.hold_program();
    verdict.came_to_rest = StopCause::RetraceEnded;
  } else if (const Phase::Homing* const homing = phase_.runs<Phase::Homing>()) {
    if (!seen.follows || seen.homings == homing->homings_before) return;
    phase_.rest();
    verdict.came_to_rest = StopCause::Homed;
  } else if (phase_.in<Phase::Running>() && mode_ == sdk::CycleMode::Manual && seen.at_rest && !seen.measures &&
             (one_move_.done || seen.moves_done > one_move_.done_before)) {
    phase_.rest();
    verdict.came_to_rest = StopCause::MoveDone;
  }
}

CycleSequencer::Verdict CycleSequencer::step(const CycleObservation& seen) noexcept {
  Verdict verdict;
  if (seen.faulted) fault(seen.emergency_stop);
  if (phase_.in<Phase::Running>() && !seen.air) phase_.stop(StopCause::AirLost);
  if (const auto* jog = phase_.runs<Phase::Jog>(); jog && seen.t_s > jog->until_s) phase_.stop(StopCause::JogLapsed);
  end_what_is_done(seen, verdict);
  if (seen.spindles_at_speed) spindle_wait_.end();
  // Only what waits for the spindle can wait too long: motion under way began with the speed it needed.
  if (phase_.in<Phase::Running>() && !phase_.positions() && seen.at_rest && spindle_wait_.too_long(seen.t_s)) {
    fault();
    verdict.spindle_timed_out = true;
  }
  if (const PathCommand command = wanted(seen); command != commanded_) {
    commanded_ = command;
    verdict.command = command;
  }
  if (const auto* jog = phase_.runs<Phase::Jog>()) verdict.jog_until_s = jog->until_s;
  return verdict;
}

}  // namespace rmac::gateway
