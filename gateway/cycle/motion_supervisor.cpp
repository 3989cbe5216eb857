#include "gateway/cycle/motion_supervisor.hpp"

#include <utility>

namespace rmac::gateway {
namespace {

constexpr std::chrono::milliseconds kNewsWait{5};

/// What a cycle that runs waits for, in a word; empty when it does not.
const char* waits_for(MachineCycle& cycle) REQUIRES(cycle.lock) {
  if (cycle.sequencer.state() != CycleState::Running) return "";
  const CycleObservation seen = cycle.observe(cycle.status());
  if (waits_for_moves(cycle.sequencer.phase(), seen)) return "moves";
  if (cycle.feed.percent() == 0) return "override";
  if (!seen.at_rest || cycle.sequencer.phase().positions()) return "";
  if (cycle.mechanism() && cycle.mechanism()->planner.waits_for_gate()) return "check";
  if (cycle.tools.asked()) return "tool";
  if (const char* const waits = cycle.program_turn.waits_for(); *waits != '\0') return waits;
  return cycle.sequencer.waits_for_spindle() ? "spindle" : "";
}

}  // namespace

MotionSupervisor::Pace MotionSupervisor::advance(const ServoStatus& status) {
  const PlannerTurn turn(cycle_.lock);
  return cycle_.advance(status);
}

Expected<> MotionSupervisor::add_steps(const char* function, std::vector<QueueStep> steps, ProgramStep as_sent) {
  const GatewayTurn turn(cycle_.lock);
  if (cycle_.queue_is_gone()) {
    return failure(MinorCode::Other, std::string(function) +
                                         ": the machine was stopped and its queue emptied meanwhile; nothing was "
                                         "queued");
  }
  cycle_.queue.add_steps(std::move(steps), std::move(as_sent));
  cycle_.steps.hand_on();
  return {};
}

ToolsNow MotionSupervisor::tools_now() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.tools.now(cycle_.queue.steps());
}

Expected<> MotionSupervisor::confirm_tool(int number) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  auto confirmed = cycle_.tools.confirm(number, cycle_.queue.steps(), cycle_.sequencer.state());
  if (!confirmed) return confirmed;
  cycle_.queue.step_done();
  cycle_.take_steps(cycle_.status());
  return {};
}

void MotionSupervisor::set_mounted(std::optional<int> number, double max_torque_nm) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.tools.set_mounted(number, max_torque_nm);
}

Expected<> MotionSupervisor::require_rest(const char* what) {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.require_rest(what);
}

void MotionSupervisor::wish(const std::function<void(ServoWishes&)>& change) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.marks.settle(cycle_.status().marks_passed);  // what comes later counts
  cycle_.wishes.change(change);
}

ServoWishes MotionSupervisor::wishes() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.wishes.now();
}

void MotionSupervisor::set_frames(const Frames& frames) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.wishes.change([&](ServoWishes& wishes) { wishes.frames = frames; });
  cycle_.queue.begin_anew();
}

void MotionSupervisor::set_spindle(std::size_t spindle, double rpm) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.wishes.change([&](ServoWishes& wishes) { wishes.spindle_rpm[spindle] = rpm; });
  cycle_.sequencer.spindle_commanded(cycle_.mechanism()->device.spindles[spindle].speed_timeout_s);
  cycle_.settle(cycle_.status());
}

std::size_t MotionSupervisor::moves_left() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.moves_left() + (cycle_.sequencer.phase().homes() ? 1 : 0);
}

CycleState MotionSupervisor::state() {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  return cycle_.sequencer.state();
}

CycleNow MotionSupervisor::now() {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  const CycleState state = cycle_.sequencer.state();
  const bool started = state == CycleState::Running || state == CycleState::Holding || state == CycleState::Stopping;
  const bool automatic = cycle_.sequencer.mode() == sdk::CycleMode::Automatic;
  const OperatorRef by = holder(cycle_);
  return {state,
          !started    ? ""
          : automatic ? "AUTOMATIC"
                      : "MANUAL",
          cycle_.feed.percent(),
          waits_for(cycle_),
          by ? by->name() : "",
          cycle_.program_turn.optional_stops(),
          cycle_.program_turn.prompt(),
          cycle_.queue.cleaned()};
}

std::shared_ptr<Mechanism> MotionSupervisor::install(std::shared_ptr<Mechanism> next, std::uint64_t generation,
                                                     bool keep_running) {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.install(std::move(next), generation, keep_running);
}

std::shared_ptr<Mechanism> MotionSupervisor::mechanism() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.mechanism();
}

std::optional<MotionSupervisor::News> MotionSupervisor::take_news() {
  // The gateway has other things to do than to wait for news.
  if (!cycle_.lock.try_lock_as_gateway(kNewsWait)) return std::nullopt;
  News news = cycle_.news.take();
  cycle_.lock.unlock_as_gateway();
  return news;
}

void MotionSupervisor::on_queued(QueueListener listener) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.queue.on_queued(std::move(listener));
}

void MotionSupervisor::report(Event event) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.news.tell(std::move(event));
}

}  // namespace rmac::gateway
