#include "gateway/cycle/machine_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
namespace {

/// With this many moves ahead, a client that pauses cannot make the queue run dry.
constexpr std::size_t kAmpleMoves = 256;

bool spindles_at_speed(const Mechanism& mechanism, const ServoWishes& wishes, const ServoStatus& status) {
  if (mechanism.virtual_mode()) return true;
  const auto& spindles = mechanism.device.spindles;
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    if (!(std::abs(status.spindle_rpm[i] - wishes.spindle_rpm[i]) <= spindles[i].speed_tolerance_rpm)) return false;
  }
  return true;
}

bool has_air(const Mechanism& mechanism, const CycleHistory& history) {
  const auto& inputs = mechanism.device.inputs;
  const auto air = inputs.find("Air");
  // No device is behind the inputs in virtual mode.
  if (air == inputs.end() || mechanism.virtual_mode()) return true;
  return (history.latest().inputs & (std::uint64_t{1} << air->second)) != 0;
}

}  // namespace

MachineCycle::MachineCycle(Options options, ServoLink& link)
    : wishes(link.wishes),
      sequencer(options.jog_while_waiting),
      queue(news),
      tools(wishes, news),
      program_turn(wishes, news),
      marks(wishes, link.marks),
      steps({queue, tools, program_turn, sequencer, marks}),
      guard(options.guard_in_thread),
      options_(options),
      link_(link) {}

CycleObservation MachineCycle::observe(const ServoStatus& status) {
  CycleObservation seen;
  seen.t_s = status.t_s;
  news.set_time(status.t_s, status.progress.cycle);
  marks.settle(status.marks_passed);
  if (!in_force_.mechanism) return seen;
  seen.moves_left = queue.planned();
  seen.done = queue.left() == 0 && queue.steps().empty();
  if (status.generation != in_force_.generation) {
    seen.spindles_at_speed = false;  // nobody knows
    return seen;
  }
  const Planner& planner = in_force_.mechanism->planner;
  seen.at_rest = !status.moving && planner.at_rest(status.progress);
  seen.retraced = seen.at_rest && planner.retraced(status.progress);
  seen.at_end = seen.at_rest && planner.at_end();
  seen.blocked = seen.at_rest && planner.blocked();
  seen.moves_done = status.moves_done;
  seen.follows = status.follows;
  seen.homings = status.homings;
  seen.reference_lost = status.reference_lost;
  seen.device = &in_force_.mechanism->device;
  seen.faulted = status.state == ServoState::Faulted;
  seen.emergency_stop = seen.faulted && status.fault.kind == ServoFault::Kind::EmergencyStop;
  seen.spindles_at_speed = spindles_at_speed(*in_force_.mechanism, wishes.now(), status);
  seen.air = has_air(*in_force_.mechanism, link_.history);
  const Measurement& measurement = probe.measurement();
  seen.measures = measurement.pending() && seen.moves_left <= measurement.steps();
  return seen;
}

void MachineCycle::settle(const ServoStatus& status) {
  if (in_force_.mechanism && sequencer.state() == CycleState::Running && wishes.turn_on_again()) await_spindles();
  const CycleObservation seen = observe(status);
  watch_probe(seen, status);
  watch_path(seen, status);
  apply_verdict(sequencer.step(seen), status);
  lead_back(seen, status);
  heed_guard(seen);
  take_steps(status);
}

void MachineCycle::watch_path(const CycleObservation& seen, const ServoStatus& status) {
  if (!in_force_.mechanism || status.generation != in_force_.generation) return;
  const bool waits = sequencer.waits_for_spindle() && !sequencer.phase().positions() && seen.at_rest;
  const bool should_move = sequencer.travels() && sequencer.state() == CycleState::Running && seen.follows && !waits &&
                           queue.planned() > 0 && feed.effective_percent() > 0 &&
                           !in_force_.mechanism->planner.off_path() && !seen.blocked &&
                           !in_force_.mechanism->planner.waits_for_gate();
  const auto wrong =
      path_watch_.step({status.t_s, should_move, status.move_id, status.s_mm, status.progress.departure});
  if (!wrong || is_faulted(sequencer.state())) return;
  news.tell(Event::Kind::Fault, *wrong, MinorCode::Other);
  sequencer.fault();
}

void MachineCycle::lead_back(const CycleObservation& seen, const ServoStatus& status) {
  if (!in_force_.mechanism || status.generation != in_force_.generation || !in_force_.mechanism->planner.off_path()) {
    told_.beside = false;
    return;
  }
  if (!seen.at_rest || is_faulted(sequencer.state())) return;
  if (!sequencer.travels()) {
    if (!std::exchange(told_.beside, true)) {
      news.tell(Event::Kind::CycleStateChanged, fmt::format("{}{}", to_string(sequencer.state()), beside_path(status)));
    }
    return;
  }
  auto led = in_force_.mechanism->planner.rejoin({status.position_set.data(), status.joint_count});
  if (led) return;
  news.tell(Event::Kind::Fault,
            fmt::format("going back to the path, which a stop has left: {}; jog away from there, and send the program "
                        "again, after a reset",
                        led.error().message),
            led.error().code);
  sequencer.fault();
  tell_state();
}

void MachineCycle::heed_guard(const CycleObservation& seen) {
  for (std::string& remark : guard.take_remarks()) news.tell(Event::Kind::NotChecked, std::move(remark));
  const auto& obstacle = guard.obstacle();
  if (!seen.blocked) told_.obstacle = false;
  if (!obstacle || !seen.blocked || is_faulted(sequencer.state())) return;
  if (!std::exchange(told_.obstacle, true)) {
    Event ahead;
    ahead.kind = Event::Kind::CollisionAhead;
    ahead.move_id = obstacle->move_id;
    ahead.message = described(*obstacle);
    ahead.code = MinorCode::Other;
    news.tell_now(std::move(ahead));
  }
  if (sequencer.phase().runs<CyclePhase::Program>() != nullptr) {
    (void)sequencer.hold();
  } else if (sequencer.phase().positions() && sequencer.state() == CycleState::Running) {
    (void)sequencer.stop();
  } else {
    return;
  }
  tell_state();
}

std::string MachineCycle::beside_path(const ServoStatus& status) const {
  return fmt::format(
      ", beside the path: no plan to stop on it was there within two cycles, so each joint came to rest by itself; the "
      "farthest is {:.3f} mm or degrees from where it left. FeedResume and CycleStart go back there first, at {:.0f} % "
      "of the joints' speeds",
      in_force_.mechanism->planner.distance_to_path({status.position_set.data(), status.joint_count}),
      100 * Planner::kRejoinSpeed);
}

void MachineCycle::notice_fault() {
  // Whatever else the servo loop reports counts when the planner has taken note of it too: in `advance`.
  const ServoStatus now = status();
  if (now.state == ServoState::Faulted) settle(now);
}

void MachineCycle::watch_probe(const CycleObservation& seen, const ServoStatus& status) {
  if (!in_force_.mechanism) return;
  if (status.generation != in_force_.generation) {
    probe.measurement().abandon();
    return;
  }
  const bool given_up = is_faulted(sequencer.state()) || sequencer.phase().empties_queue();
  const ProbeWatch::Verdict verdict =
      probe.step({seen.moves_left, seen.at_rest, status.probe, sequencer.phase().positions(), given_up});
  if (verdict.touched) sequencer.touched();
  if (verdict.stop) (void)sequencer.stop_and_clear(seen, *verdict.stop);
}

void MachineCycle::apply_verdict(const CycleSequencer::Verdict& verdict, const ServoStatus& status) {
  if (const bool homes = sequencer.phase().homes(); wishes.now().home != homes) {
    queue.begin_anew();
    wishes.change([homes](ServoWishes& wish) { wish.home = homes; });
  }
  if (const double until_s = verdict.jog_until_s.value_or(std::numeric_limits<double>::infinity());
      wishes.now().moves_until_s != until_s) {
    wishes.change([until_s](ServoWishes& wish) { wish.moves_until_s = until_s; });
    jogs_.store(verdict.jog_until_s.has_value(), std::memory_order_release);
  }
  if (in_force_.mechanism && verdict.command) {
    link_.stops.planned.store(*verdict.command == PathCommand::Stop, std::memory_order_release);
    in_force_.mechanism->planner.command(*verdict.command);
  }
  if (in_force_.mechanism && verdict.clear_queue) empty_queue(status);
  if (verdict.spindle_timed_out) tell_spindle_timeout(status);
  if (verdict.came_to_rest) {
    const bool beside = in_force_.mechanism && in_force_.mechanism->planner.off_path();
    told_.beside = beside;
    news.tell(Event::Kind::Stopped, describe(*verdict.came_to_rest) + (beside ? beside_path(status) : std::string()),
              code_of(*verdict.came_to_rest));
  }
  if (sequencer.state() == CycleState::Idle && feed.end_jog()) apply_feed();
  tell_state();
}

void MachineCycle::tell_spindle_timeout(const ServoStatus& status) {
  std::string speeds;
  for (std::size_t i = 0; i < in_force_.mechanism->device.spindles.size(); ++i) {
    speeds += fmt::format("{}spindle {} turns at {:.0f} of {:.0f} rpm", i == 0 ? "" : ", ", i, status.spindle_rpm[i],
                          wishes.now().spindle_rpm[i]);
  }
  news.tell(Event::Kind::Fault,
            fmt::format("{}: not at speed within the time allowed, so no move was begun; check the spindle's drive, "
                        "then reset",
                        speeds),
            MinorCode::ResponseTimeout);
}

void MachineCycle::tell_state() {
  const CycleState state = sequencer.state();
  const CyclePhase& phase = sequencer.phase();
  const bool program = phase.runs<CyclePhase::Program>() != nullptr || phase.holds<CyclePhase::Program>() != nullptr;
  if (program != wishes.now().program) wishes.change([program](ServoWishes& wish) { wish.program = program; });
  if (state == told_.state) return;
  news.tell(Event::Kind::CycleStateChanged, fmt::format("{} to {}", to_string(told_.state), to_string(state)),
            MinorCode::None, state == CycleState::Running);
  told_.state = state;
  if (state == CycleState::EmergencyStop) marks.drop();
  wishes.change([state](ServoWishes& wish) {
    wish.state = state;
    if (is_faulted(state)) {
      wish.spindle_rpm.fill(0);
      wish.force.fill(0);
    }
    // Nothing may flow, open or close when the stop is released.
    if (state == CycleState::EmergencyStop) wish.outputs = 0;
  });
}

void MachineCycle::take_steps(const ServoStatus& status) {
  while (!queue.steps().empty() && in_force_.mechanism && status.generation == in_force_.generation &&
         !is_faulted(sequencer.state())) {
    steps.hand_on();  // what is handed on is seen to be there
    const CycleObservation seen = observe(status);
    switch (steps.take(seen, {seen.t_s, link_.history.latest().inputs, in_force_.mechanism->virtual_mode()})) {
      case QueueSteps::Came::Nothing:
        return;
      case QueueSteps::Came::Done:
        continue;
      case QueueSteps::Came::SpindlesTold:
        await_spindles();
        continue;
      case QueueSteps::Came::ToolMounted:
        in_force_.mechanism->planner.clear();  // what was cut with another tool is not retraced with this one
        guard.set_tool(tools.last_mounted());
        continue;
      case QueueSteps::Came::Held:
      case QueueSteps::Came::Failed:
        tell_state();
        return;
    }
  }
}

Planning::Pace MachineCycle::advance(const ServoStatus& status) {
  settle(status);
  if (!in_force_.mechanism || status.generation != in_force_.generation) return Planning::Pace::Calm;
  if (!is_faulted(sequencer.state())) {
    in_force_.mechanism->planner.rest_follows(!queue.steps().empty());
    in_force_.mechanism->planner.step(status.progress);
    // In virtual time nothing moves meanwhile.
    if (in_force_.mechanism->planner.waits_for_gate()) return Planning::Pace::Sending;
    if (!in_force_.mechanism->planner.idle(status.progress)) return Planning::Pace::Planning;
  }
  return pace(status);
}

Planning::Pace MachineCycle::pace(const ServoStatus& status) {
  const CycleState state = sequencer.state();
  const std::size_t left = queue.planned();
  if (state == CycleState::Running && left > 0 && left < kAmpleMoves && left < options_.queue_capacity &&
      sequencer.mode() == sdk::CycleMode::Automatic &&
      std::chrono::steady_clock::now() - queue.last_added() < options_.client_grace) {
    return Planning::Pace::Sending;
  }
  const bool between = !queue.steps().empty() && !tools.asked();
  const bool waiting = state == CycleState::Running && (left > 0 || between || sequencer.waits_for_spindle());
  const bool coming_to_rest = status.moving || !in_force_.mechanism->planner.at_rest(status.progress);
  const bool busy = waiting || coming_to_rest || sequencer.phase().homes() || state == CycleState::Stopping ||
                    status.state == ServoState::Enabling;
  return busy && !is_faulted(state) ? Planning::Pace::Busy : Planning::Pace::Calm;
}

Expected<> MachineCycle::ready_for_move() {
  if (!in_force_.mechanism) {
    return failure(MinorCode::Other, "there is no mechanism; load one with Device.Load before sending moves");
  }
  const CycleState state = sequencer.state();
  if (is_faulted(state)) {
    return failure(
        state == CycleState::Faulted ? MinorCode::Other : MinorCode::EmergencyStop,
        fmt::format("no moves are taken while the machine is {}; remove the cause, then reset", to_string(state)));
  }
  if (sequencer.phase().empties_queue()) {
    return failure(MinorCode::Other, "the queue is being emptied; send moves when the machine has stopped");
  }
  if (const std::size_t left = moves_left(); left >= options_.queue_capacity) {
    return failure(
        MinorCode::CommandQueueFull,
        fmt::format("the queue holds {} moves, as many as it can; send the next one when a move is done", left));
  }
  if (!queue.begins_anew()) return {};
  const ServoStatus now = status();
  const CycleObservation seen = observe(now);
  if (state == CycleState::Stopping || !seen.at_rest) {
    return failure(MinorCode::Other, "the machine is still coming to rest; send moves when it has stopped");
  }
  if (now.generation != in_force_.generation || !now.follows) {
    return failure(MinorCode::Other, "the drives are not enabled yet; send moves when they are");
  }
  queue.begin_here(now.moves_done);
  builder().restart({now.position_set.data(), now.joint_count}, wishes.now().frames);
  return {};
}

bool MachineCycle::queue_is_gone() {
  if (!queue.begins_anew() && !sequencer.phase().empties_queue()) return false;
  queue.begin_anew();
  return true;
}

Expected<std::size_t> MachineCycle::add(std::vector<BuiltMove> built) {
  if (queue_is_gone()) {
    return failure(MinorCode::Other, move_name(std::get<Move>(built.front().as_sent.what).id) +
                                         ": the machine was stopped and its queue emptied before the move was "
                                         "ready; nothing was queued");
  }
  std::size_t moving = 0;
  for (BuiltMove& move : built) {
    if (queue.add(std::move(move))) ++moving;
  }
  return moving;
}

Expected<> MachineCycle::require_rest(const char* what) {
  if (!in_force_.mechanism) return {};
  const CycleObservation seen = observe(status());
  if (probe.measurement().pending()) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs the machine at rest, and a point is being measured; wait until that is done, "
                               "or drop it with StopNow",
                               what));
  }
  if (!seen.at_rest || sequencer.state() == CycleState::Stopping) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs the machine at rest, and it is moving; wait for its moves or "
                               "stop it first",
                               what));
  }
  if (const std::size_t left = queue.planned() + queue.waiting(); left > 0) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs an empty queue, and {} moves are still in it; run them, park "
                               "them with ParkProgram, or drop them with StopNow",
                               what, left));
  }
  return {};
}

std::size_t MachineCycle::moves_left() {
  // Samples tell of a move that is done before the planning thread comes to count it.
  const ServoStatus now = status();
  if (in_force_.mechanism && now.generation == in_force_.generation && !is_faulted(sequencer.state())) {
    in_force_.mechanism->planner.follow(now.progress);
  }
  const std::size_t left = queue.left();
  const Measurement& measurement = probe.measurement();
  if (!measurement.pending()) return left;
  return left - std::min(left, measurement.steps()) + 1;  // the client's is one
}

void MachineCycle::empty_queue(const ServoStatus& status) {
  wishes.forget_later();
  marks.settle(status.marks_passed);
  marks.drop();
  tools.drop(queue.clear(status.progress.cycle, status.generation == in_force_.generation ? status.moves_done : 0));
  program_turn.drop();
}

void MachineCycle::apply_feed() {
  if (in_force_.mechanism) in_force_.mechanism->planner.set_override(feed.effective_percent());
}

void MachineCycle::await_spindles() {
  double patience_s = 0;
  for (const sdk::Spindle& spindle : in_force_.mechanism->device.spindles) {
    patience_s = std::max(patience_s, spindle.speed_timeout_s);
  }
  sequencer.spindle_commanded(patience_s);
}

std::shared_ptr<Mechanism> MachineCycle::install(std::shared_ptr<Mechanism> next, std::uint64_t generation,
                                                 bool keep_running) {
  std::swap(in_force_.mechanism, next);
  if (next) {
    next->planner.give_way_to(nullptr);
    next->planner.set_gate(nullptr);
  }
  guard.forget();
  guard.wait_until_idle();
  if (in_force_.mechanism) {
    in_force_.mechanism->planner.give_way_to(&interruption);
    in_force_.mechanism->planner.set_gate(guard.on() ? &guard : nullptr);
  }
  in_force_.generation = generation;
  builder_ = in_force_.mechanism ? &in_force_.mechanism->builder : nullptr;
  wishes.forget_later();
  tools.drop(queue.forget());
  program_turn.drop();
  marks.drop();
  path_watch_.restart();
  queue.install(in_force_.mechanism ? &in_force_.mechanism->planner : nullptr);
  apply_feed();
  const ServoStatus now = status();
  probe.install(in_force_.mechanism && in_force_.mechanism->virtual_mode(), now.probe);
  sequencer.mechanism_changed(keep_running);
  news.tell({QueueChange::Kind::Replaced, 0, now.progress.cycle, {}});
  settle(now);
  return next;
}

}  // namespace rmac::gateway
