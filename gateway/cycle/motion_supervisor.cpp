#include "gateway/cycle/motion_supervisor.hpp"

#include <utility>

namespace rmac::gateway {
namespace {

constexpr std::chrono::milliseconds kNewsWait{5};

}  // namespace

MotionSupervisor::Pace MotionSupervisor::advance(const ServoStatus& status) {
  const PlannerTurn turn(cycle_.lock);
  return cycle_.advance(status);
}

Expected<double> MotionSupervisor::retrace(double distance_mm) {
  const GatewayTurn turn(cycle_.lock);
  if (auto fine = cycle_.sequencer.check_retrace(cycle_.observe(cycle_.status())); !fine) {
    return tl::unexpected(fine.error());
  }
  const ServoStatus now = cycle_.status();
  auto way = cycle_.mechanism()->planner.turn_back(distance_mm, {now.position_set.data(), now.joint_count});
  if (!way) return way;
  if (!(*way > 0)) {
    return failure(MinorCode::Other,
                   "FeedRetrace: there is no path behind the tool; it stands where its path began, or where the queue "
                   "was emptied");
  }
  cycle_.sequencer.retrace();
  cycle_.settle(cycle_.status());
  return way;
}

Expected<> MotionSupervisor::add_steps(std::vector<QueueStep> steps, ProgramStep as_sent) {
  const GatewayTurn turn(cycle_.lock);
  if (cycle_.queue_is_gone()) {
    return failure(MinorCode::Other,
                   "DoToolChange: the machine was stopped and its queue emptied meanwhile; nothing was queued");
  }
  cycle_.queue.add_steps(std::move(steps), std::move(as_sent));
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

void MotionSupervisor::set_override(double percent) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.feed.set(percent);
  cycle_.apply_feed();
}

void MotionSupervisor::set_spindle(std::size_t spindle, double rpm) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.wishes.change([&](ServoWishes& wishes) { wishes.spindle_rpm[spindle] = rpm; });
  cycle_.sequencer.spindle_commanded(cycle_.mechanism()->device.spindles[spindle].speed_timeout_s);
  cycle_.settle(cycle_.status());
}

std::size_t MotionSupervisor::moves_left() {
  const GatewayTurn turn(cycle_.lock);
  return cycle_.moves_left() + (cycle_.sequencer.homes() ? 1 : 0);
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
  return {state, !started ? "" : automatic ? "AUTOMATIC" : "MANUAL", cycle_.feed.percent()};
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
