#include "gateway/cycle/motion_supervisor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {

namespace {
/// With this many moves ahead, a client that pauses cannot make the queue run dry.
constexpr std::size_t kAmpleMoves = 256;
/// A jog by velocity stops when it was not renewed for so long (the design's dead-man).
constexpr double kJogLasts_s = 0.2;
}  // namespace

MotionSupervisor::MotionSupervisor(Options options, ServoLink& link) : options_(options), link_(link) {}

MotionSupervisor::Turn::Turn(MotionSupervisor& supervisor) : supervisor_(supervisor) {
  supervisor_.gateway_waits_.fetch_add(1, std::memory_order_relaxed);
  supervisor_.mutex_.lock();
  supervisor_.gateway_waits_.fetch_sub(1, std::memory_order_relaxed);
}

MotionSupervisor::Turn::~Turn() {
  supervisor_.work_to_do_ = true;
  supervisor_.mutex_.unlock();
  supervisor_.work_.notify_one();
}

CycleObservation MotionSupervisor::observe(const ServoStatus& status) {
  CycleObservation seen;
  seen.t_s = status.t_s;
  t_s_ = status.t_s;
  cycle_ = status.progress.cycle;
  if (!mechanism_) return seen;
  seen.moves_left = mechanism_->planner.moves_left();
  if (status.generation != generation_) return seen;
  seen.at_rest = !status.moving && mechanism_->planner.at_rest(status.progress);
  seen.retraced = seen.at_rest && mechanism_->planner.retraced(status.progress);
  seen.moves_done = status.moves_done;
  seen.follows = status.follows;
  seen.homings = status.homings;
  seen.faulted = status.state == ServoState::Faulted;
  seen.emergency_stop = seen.faulted && status.fault.kind == ServoFault::Kind::EmergencyStop;
  seen.spindles_at_speed = spindles_at_speed(status);
  seen.air = has_air();
  seen.measures = measurement_.pending() && seen.moves_left <= measurement_.steps();
  return seen;
}

bool MotionSupervisor::spindles_at_speed(const ServoStatus& status) const {
  if (mechanism_->virtual_mode()) return true;
  const auto& spindles = mechanism_->device.spindles;
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    if (!(std::abs(status.spindle_rpm[i] - wishes_.spindle_rpm[i]) <= spindles[i].speed_tolerance_rpm)) return false;
  }
  return true;
}

bool MotionSupervisor::has_air() const {
  const auto& inputs = mechanism_->device.inputs;
  const auto air = inputs.find("Air");
  // No device is behind the inputs in virtual mode.
  if (air == inputs.end() || mechanism_->virtual_mode()) return true;
  return (link_.history.latest().inputs & (std::uint64_t{1} << air->second)) != 0;
}

void MotionSupervisor::settle(const ServoStatus& status) {
  restart_spindles();
  const CycleObservation seen = observe(status);
  watch_probe(seen, status);
  apply_verdict(sequencer_.step(seen), status);
  take_steps(status);
}

void MotionSupervisor::notice_fault() {
  // Of the rest, what the servo loop reports counts when the planner has taken note of it too: in `advance`.
  const ServoStatus now = status();
  if (now.state == ServoState::Faulted) settle(now);
}

void MotionSupervisor::apply_verdict(const CycleSequencer::Verdict& verdict, const ServoStatus& status) {
  if (wishes_.home != sequencer_.homes()) {
    wishes_.home = sequencer_.homes();
    rebase_ = true;
    link_.wishes.write(wishes_);
  }
  if (mechanism_ && verdict.command) mechanism_->planner.command(*verdict.command);
  if (mechanism_ && verdict.clear_queue) {
    mechanism_->planner.clear();
    rebase_ = true;
    forget_moves();
    news_.queue.push_back({QueueChange::Kind::Cleared, 0, status.progress.cycle});
  }
  if (verdict.spindle_timed_out) {
    std::string speeds;
    for (std::size_t i = 0; i < mechanism_->device.spindles.size(); ++i) {
      speeds += fmt::format("{}spindle {} turns at {:.0f} of {:.0f} rpm", i == 0 ? "" : ", ", i, status.spindle_rpm[i],
                            wishes_.spindle_rpm[i]);
    }
    note({Event::Kind::Fault,
          t_s_,
          0,
          fmt::format("{}: not at speed within the time allowed, so no move was begun; check the spindle's drive, then "
                      "reset",
                      speeds),
          cycle_,
          {},
          MinorCode::ResponseTimeout});
  }
  if (verdict.came_to_rest) {
    const StopCause cause = *verdict.came_to_rest;
    note({Event::Kind::Stopped, t_s_, 0, describe(cause), cycle_, {}, code_of(cause)});
  }
  if (jog_share_ != 1 && sequencer_.state() == CycleState::Idle) {
    jog_share_ = 1;
    apply_override();
  }
  tell_state();
}

void MotionSupervisor::tell_state() {
  const CycleState state = sequencer_.state();
  if (state == reported_state_) return;
  note({Event::Kind::CycleStateChanged,
        t_s_,
        0,
        fmt::format("{} to {}", to_string(reported_state_), to_string(state)),
        cycle_,
        {}});
  reported_state_ = state;
  wishes_.state = state;
  if (is_faulted(state)) {
    wishes_.spindle_rpm.fill(0);
    wishes_.force.fill(0);
  }
  // Nothing may flow, open or close when the stop is released.
  if (state == CycleState::EmergencyStop) wishes_.outputs = 0;
  link_.wishes.write(wishes_);
}

MotionSupervisor::Pace MotionSupervisor::advance(const ServoStatus& status) {
  // Yielding to a waiting gateway costs at most one scheduling round; barging ahead could starve it for ever.
  while (gateway_waits_.load(std::memory_order_relaxed) > 0) std::this_thread::yield();
  const std::lock_guard lock(mutex_);
  work_to_do_ = false;
  settle(status);
  if (!mechanism_ || status.generation != generation_) return Pace::Calm;
  if (!is_faulted(sequencer_.state())) {
    mechanism_->planner.step(status.progress);
    if (!mechanism_->planner.idle(status.progress)) return Pace::Planning;
  }
  return pace(status);
}

MotionSupervisor::Pace MotionSupervisor::pace(const ServoStatus& status) {
  const CycleState state = sequencer_.state();
  const std::size_t left = mechanism_->planner.moves_left();
  if (state == CycleState::Running && left > 0 && left < kAmpleMoves && left < options_.queue_capacity &&
      sequencer_.mode() == sdk::CycleMode::Automatic &&
      std::chrono::steady_clock::now() - last_added_ < options_.client_grace) {
    return Pace::Sending;
  }
  const bool steps = !behind_.empty() && !asked_;
  const bool waiting = state == CycleState::Running && (left > 0 || steps || sequencer_.waits_for_spindle());
  const bool coming_to_rest = status.moving || !mechanism_->planner.at_rest(status.progress);
  const bool busy = waiting || coming_to_rest || sequencer_.homes() || state == CycleState::Stopping ||
                    status.state == ServoState::Enabling;
  return busy && !is_faulted(state) ? Pace::Busy : Pace::Calm;
}

void MotionSupervisor::wait_for_work(std::chrono::nanoseconds period) {
  std::unique_lock lock(mutex_);
  work_.wait_for(lock, period, [this] { return work_to_do_; });
}

Expected<> MotionSupervisor::prepare_move() {
  const Turn turn(*this);
  notice_fault();
  if (measurement_.pending()) {
    return failure(MinorCode::CommandQueueFull,
                   "a point is being measured, or waits for CycleStart to be, and the next move begins where that "
                   "ends; send it when the point is measured");
  }
  return ready_for_move();
}

Expected<> MotionSupervisor::ready_for_move() {
  if (!mechanism_) {
    return failure(MinorCode::Other, "there is no mechanism; load one with Device.Load before sending moves");
  }
  const CycleState state = sequencer_.state();
  if (is_faulted(state)) {
    return failure(
        state == CycleState::Faulted ? MinorCode::Other : MinorCode::EmergencyStop,
        fmt::format("no moves are taken while the machine is {}; remove the cause, then reset", to_string(state)));
  }
  if (state == CycleState::Stopping && sequencer_.clears_at_rest()) {
    return failure(MinorCode::Other, "the queue is being emptied; send moves when the machine has stopped");
  }
  if (const std::size_t left = count_moves(); left >= options_.queue_capacity) {
    return failure(
        MinorCode::CommandQueueFull,
        fmt::format("the queue holds {} moves, as many as it can; send the next one when a move is done", left));
  }
  if (!rebase_) return {};
  const ServoStatus now = status();
  const CycleObservation seen = observe(now);
  if (state == CycleState::Stopping || !seen.at_rest) {
    return failure(MinorCode::Other, "the machine is still coming to rest; send moves when it has stopped");
  }
  if (now.generation != generation_ || !now.follows) {
    return failure(MinorCode::Other, "the drives are not enabled yet; send moves when they are");
  }
  // After a retrace the path ends elsewhere than where the machine stands.
  mechanism_->planner.clear();
  mechanism_->builder.restart({now.position_set.data(), now.joint_count}, wishes_.frames);
  rebase_ = false;
  return {};
}

Expected<bool> MotionSupervisor::add_move(const Move& move) {
  return build_and_add({{&move, {}}}).map([](std::size_t moving) { return moving > 0; });
}

Expected<std::size_t> MotionSupervisor::build_and_add(const std::vector<PartOfMove>& parts,
                                                      const std::function<void(std::size_t)>& then) {
  // The builder is the gateway thread's alone; building may take long, and planning goes on meanwhile.
  std::optional<PathBuilder> before;
  if (parts.size() > 1) before = mechanism_->builder;
  std::vector<PathSegments> built;
  std::vector<ProgramStep> steps;
  for (const PartOfMove& part : parts) {
    steps.push_back(step_at(mechanism_->builder, *part.move));
    auto segments = mechanism_->builder.build(*part.move);
    if (!segments) {
      if (before) mechanism_->builder = std::move(*before);
      return tl::unexpected(segments.error());
    }
    built.push_back(std::move(*segments));
  }
  const Turn turn(*this);
  // Built to follow a queue that is gone.
  if (rebase_ || (sequencer_.state() == CycleState::Stopping && sequencer_.clears_at_rest())) {
    rebase_ = true;
    return failure(MinorCode::Other, move_name(parts.front().move->id) +
                                         ": the machine was stopped and its queue emptied before the move was "
                                         "ready; nothing was queued");
  }
  std::size_t moving = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (add_built(parts[i], std::move(built[i]))) ++moving;
    program_.add(std::move(steps[i]), count_left());
  }
  if (then) then(moving);
  return moving;
}

bool MotionSupervisor::add_built(const PartOfMove& part, PathSegments segments) {
  const bool moves = !segments.empty();
  if (queue_listener_) queue_listener_(*part.move, segments);
  if (behind_.empty()) {
    hand_on({part.move->id, part.part, std::move(segments)});
  } else {
    behind_.emplace_back(QueuedPath{part.move->id, part.part, std::move(segments)});
  }
  last_added_ = std::chrono::steady_clock::now();
  return moves;
}

void MotionSupervisor::hand_on(QueuedPath path) {
  const bool moves = !path.segments.empty();
  mechanism_->planner.add(std::move(path.segments));
  if (moves) {
    ++moves_added_;
  } else {
    still_moves_.push_back(moves_added_);
  }
  news_.queue.push_back({moves ? QueueChange::Kind::Added : QueueChange::Kind::Still, path.move_id, 0, path.part});
}

Expected<> MotionSupervisor::run_positioning(const Move& move, std::optional<double> share) {
  return command([](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.check_positioning(seen); })
      .and_then([&] { return require_rest("a jog"); })
      .and_then([&] {
        begin_where_it_stands();
        return prepare_move();
      })
      .and_then([&] { return add_move(move); })
      .and_then([&](bool moves) {
        if (!moves) return Expected<>{};
        return command([&](CycleSequencer& cycle, const CycleObservation& seen) {
          jog_share_ = share.value_or(1);
          apply_override();
          return cycle.start_positioning(seen, share ? std::optional(kJogLasts_s) : std::nullopt);
        });
      });
}

void MotionSupervisor::begin_where_it_stands() {
  const Turn turn(*this);
  rebase_ = true;
}

bool MotionSupervisor::renew_jog(double share) {
  const Turn turn(*this);
  const ServoStatus now = status();
  settle(now);  // it may have ended since
  if (!sequencer_.jogs()) return false;
  sequencer_.renew_jog(observe(now), kJogLasts_s);
  jog_share_ = share;
  apply_override();
  return true;
}

Expected<> MotionSupervisor::end_jog() {
  return command(
      [](CycleSequencer& cycle, const CycleObservation&) { return cycle.jogs() ? cycle.stop() : Expected<>{}; });
}

Expected<double> MotionSupervisor::retrace(double distance_mm) {
  const Turn turn(*this);
  if (auto fine = sequencer_.check_retrace(observe(status())); !fine) return tl::unexpected(fine.error());
  const double way = mechanism_->planner.turn_back(distance_mm);
  if (!(way > 0)) {
    return failure(MinorCode::Other,
                   "FeedRetrace: there is no path behind the tool; it stands where its path began, or where the queue "
                   "was emptied");
  }
  sequencer_.retrace();
  settle(status());
  return way;
}

Expected<> MotionSupervisor::require_rest(const char* what) {
  const Turn turn(*this);
  if (!mechanism_) return {};
  const CycleState state = sequencer_.state();
  const CycleObservation seen = observe(status());
  if (measurement_.pending()) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs the machine at rest, and a point is being measured; wait until that is done, "
                               "or drop it with StopNow",
                               what));
  }
  if (!seen.at_rest || state == CycleState::Stopping) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs the machine at rest, and it is moving; wait for its moves or "
                               "stop it first",
                               what));
  }
  if (const std::size_t left = seen.moves_left + steps_left(); left > 0) {
    return failure(MinorCode::Other,
                   fmt::format("{} needs an empty queue, and {} moves are still in it; run them, park "
                               "them with ParkProgram, or drop them with StopNow",
                               what, left));
  }
  return {};
}

void MotionSupervisor::wish(const std::function<void(ServoWishes&)>& change) {
  const Turn turn(*this);
  change(wishes_);
  link_.wishes.write(wishes_);
}

ServoWishes MotionSupervisor::wishes() {
  const Turn turn(*this);
  return wishes_;
}

void MotionSupervisor::set_frames(const Frames& frames) {
  const Turn turn(*this);
  wishes_.frames = frames;
  link_.wishes.write(wishes_);
  rebase_ = true;
}

void MotionSupervisor::set_override(double percent) {
  const Turn turn(*this);
  override_percent_ = percent;
  apply_override();
}

void MotionSupervisor::apply_override() {
  if (mechanism_) mechanism_->planner.set_override(override_percent_ * jog_share_);
}

void MotionSupervisor::set_spindle(std::size_t spindle, double rpm) {
  const Turn turn(*this);
  wishes_.spindle_rpm[spindle] = rpm;
  link_.wishes.write(wishes_);
  sequencer_.spindle_commanded(mechanism_->device.spindles[spindle].speed_timeout_s);
  settle(status());
}

std::size_t MotionSupervisor::moves_left() {
  const Turn turn(*this);
  return count_moves() + (sequencer_.homes() ? 1 : 0);
}

std::size_t MotionSupervisor::count_left() {
  if (!mechanism_) return 0;
  const std::size_t left = mechanism_->planner.moves_left();
  // A move without motion is done when those before it are.
  while (!still_moves_.empty() && still_moves_.front() + left <= moves_added_) still_moves_.pop_front();
  return left + still_moves_.size() + steps_left();
}

std::size_t MotionSupervisor::count_moves() {
  const std::size_t left = count_left();
  if (!measurement_.pending()) return left;
  return left - std::min(left, measurement_.steps()) + 1;  // the client's is one
}

void MotionSupervisor::forget_moves() {
  moves_added_ = 0;
  still_moves_.clear();
  program_.clear();
  resumes_with_.reset();
  drop_steps();
}

CycleState MotionSupervisor::state() {
  const Turn turn(*this);
  notice_fault();
  return sequencer_.state();
}

CycleNow MotionSupervisor::now() {
  const Turn turn(*this);
  notice_fault();
  const CycleState state = sequencer_.state();
  const bool started = state == CycleState::Running || state == CycleState::Holding || state == CycleState::Stopping;
  const bool automatic = sequencer_.mode() == sdk::CycleMode::Automatic;
  return {state, !started ? "" : automatic ? "AUTOMATIC" : "MANUAL", override_percent_};
}

std::shared_ptr<Mechanism> MotionSupervisor::install(std::shared_ptr<Mechanism> next, std::uint64_t generation,
                                                     bool keep_running) {
  const Turn turn(*this);
  std::swap(mechanism_, next);
  generation_ = generation;
  rebase_ = true;
  apply_override();
  forget_moves();
  measurement_.abandon();
  if (mechanism_) measurement_.count_from(probe(this->status()).hits);
  sequencer_.mechanism_changed(keep_running);
  news_.queue.push_back({QueueChange::Kind::Replaced, 0, status().progress.cycle});
  settle(status());
  return next;
}

std::shared_ptr<Mechanism> MotionSupervisor::mechanism() {
  const Turn turn(*this);
  return mechanism_;
}

MotionSupervisor::News MotionSupervisor::take_news() {
  const Turn turn(*this);
  return std::exchange(news_, {});
}

void MotionSupervisor::report(Event event) {
  const Turn turn(*this);
  note(std::move(event));
}

}  // namespace rmac::gateway
