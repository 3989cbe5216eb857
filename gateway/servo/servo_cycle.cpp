#include "gateway/servo/servo_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/servo/servo_handover.hpp"

namespace rmac::gateway {
namespace {

/// A stop on the path is waited for so long. The planner aims at this (`PlanningTime::kShortestLead`).
constexpr std::int64_t kStopsOnPath = 2;

}  // namespace

void ServoCycle::run(std::uint64_t missed) noexcept {
  serve_swap();
  ++cycle_;
  const ServoWishes& wishes = link_.wishes.read();
  sample_.cycle = cycle_;
  sample_.t_s = static_cast<double>(cycle_) * period_s_;
  sample_.deadline_misses += missed;
  command_.cycles_missed = missed;
  if (mechanism_ != nullptr) move(wishes);
  publish(wishes);
}

void ServoCycle::serve_swap() noexcept {
  SwapRequest* const request = link_.swap.exchange(nullptr, std::memory_order_acq_rel);
  if (request == nullptr) return;
  if (!request->laws.empty() || !request->methods.empty() || request->learns) {
    request->result.store(change_loops(*request), std::memory_order_release);
    return;
  }
  if (status_.moving) {
    request->result.store(SwapRequest::Result::Refused, std::memory_order_release);
    return;
  }
  take_over(request->next);
  status_.generation = request->generation;
  // Whoever asked may destroy the old mechanism, and the request, from here on.
  request->result.store(SwapRequest::Result::Done, std::memory_order_release);
}

SwapRequest::Result ServoCycle::change_loops(SwapRequest& request) noexcept {
  constexpr double kOnPlan = 1e-6;  // mm or degrees
  ServoLoop& loop = *mechanism_->loop;
  for (const SwapRequest::Method& other : request.methods) {
    const bool keeps_position = other.method == ControlMethod::Position;
    if (keeps_position && std::abs(loop.slipped(other.joint)) > kOnPlan) return SwapRequest::Result::Refused;
  }
  for (const SwapRequest::Method& other : request.methods) loop.set_control_method(other.joint, other.method);
  for (SwapRequest::Law& other : request.laws) other.joint->exchange(other.law);
  loop.exchange_learned(request.learned);
  return SwapRequest::Result::Done;
}

void ServoCycle::take_over(Mechanism* next) noexcept {
  if (next != nullptr && mechanism_ != nullptr && next->loop != mechanism_->loop) {
    next->loop->engage(mechanism_->loop->handover());
  }
  const bool same_loop = next != nullptr && mechanism_ != nullptr && next->loop == mechanism_->loop;
  mechanism_ = next;
  const std::uint64_t misses = sample_.deadline_misses;
  const std::uint64_t lost = sample_.samples_lost;
  sample_ = CycleSample{};
  sample_.deadline_misses = misses;
  sample_.samples_lost = lost;
  status_ = ServoStatus{};
  if (!same_loop) {
    report_ = ServoReport{};
    link_.times.clear();
  }
  // The first cycle puts the follower where the joints hold.
  report_.follows = false;
}

void ServoCycle::move(const ServoWishes& wishes) noexcept {
  ServoLoop& loop = *mechanism_->loop;
  command_.frames = wishes.frames;
  command_.power = wishes.power && !link_.stops.power_off.load(std::memory_order_acquire);
  command_.reset = wishes.reset;
  command_.home = wishes.home;
  command_.spindle_rpm = wishes.spindle_rpm;
  command_.tool_torque_nm = wishes.tool_torque_nm;
  command_.force = wishes.force;
  if (!report_.follows) mechanism_->follower.hold_at(loop.hold_position().first(loop.joint_count()));
  see_to_stop(wishes);
  mechanism_->follower.sample(cycle_, command_.setpoint);
  command_.program = wishes.program && wishes.learned && !mechanism_->follower.off_path();
  const std::uint64_t done = report_.follows ? command_.setpoint.moves_done : 0;
  command_.outputs = outputs_.step(wishes.outputs, wishes.marks_settled, status_.moves_done + done);

  const ServoFault::Kind before = report_.fault.kind;
  loop.cycle(command_, report_);

  const Setpoint& setpoint = command_.setpoint;
  status_.progress = {cycle_, mechanism_->follower.accepted_plan(), mechanism_->follower.last_refused(),
                      mechanism_->follower.departure()};
  status_.state = report_.state;
  status_.fault = report_.fault;
  status_.follows = report_.follows;
  status_.moving = (report_.follows && setpoint.moving) || report_.state == ServoState::Homing;
  status_.move_id = setpoint.move_id;
  status_.s_mm = setpoint.s_mm;
  status_.homings = report_.homings;
  status_.reference_lost = report_.reference_lost;
  status_.probe = report_.probe;
  if (report_.follows) status_.moves_done += setpoint.moves_done;
  status_.marks_passed = outputs_.passed();
  status_.joint_count = static_cast<std::uint32_t>(loop.joint_count());
  status_.joint_count_with_held = static_cast<std::uint32_t>(loop.joint_count_with_held());
  status_.position_set = report_.position_set;
  status_.spindle_rpm = report_.spindle_rpm;

  if (report_.fault.kind != before && report_.fault.kind != ServoFault::Kind::None) {
    // A full ring holds 64 faults that nobody has read: the first ones are those that matter.
    (void)link_.faults.push({cycle_, sample_.t_s, status_.generation, setpoint.move_id, setpoint.s_mm, report_.fault});
  }
}

void ServoCycle::see_to_stop(const ServoWishes& wishes) noexcept {
  if (!link_.stops.stop() && sample_.t_s <= wishes.moves_until_s) {
    stop_seen_ = kNever;
    return;
  }
  if (stop_seen_ == kNever) stop_seen_ = cycle_;
  if (cycle_ - stop_seen_ >= kStopsOnPath) mechanism_->follower.leave();
}

void ServoCycle::fill_pose_set() noexcept {
  if (status_.moving && status_.follows && !mechanism_->follower.off_path()) {
    sample_.pose_set = command_.setpoint.pose;
    return;
  }
  const ServoLoop& loop = *mechanism_->loop;
  const std::span<const double> joints(report_.position_set.data(), loop.joint_count());
  sample_.pose_set =
      apply_to_pose(inverse(command_.frames.part), pose_of(*loop.parts().kinematics, joints, command_.frames.tool));
}

void ServoCycle::publish(const ServoWishes& wishes) noexcept {
  status_.t_s = sample_.t_s;
  status_.progress.cycle = cycle_;
  sample_.state = wishes.state;
  if (status_.state == ServoState::Faulted) {
    const bool pressed = status_.fault.kind == ServoFault::Kind::EmergencyStop;
    sample_.state = pressed ? CycleState::EmergencyStop : CycleState::Faulted;
  }
  if (mechanism_ != nullptr) {
    sample_.joint_count = status_.joint_count;
    sample_.joint_count_with_held = status_.joint_count_with_held;
    sample_.actuator_count = static_cast<std::uint32_t>(mechanism_->loop->parts().actuators.size());
    sample_.servo_state = status_.state;
    sample_.fault = status_.fault;
    sample_.moving = status_.moving;
    const bool in_turn = wishes.in_turn && !status_.moving;
    sample_.move_id = in_turn ? *wishes.in_turn : command_.setpoint.move_id;
    sample_.s_mm = in_turn ? 0 : command_.setpoint.s_mm;
    sample_.feed_set_mm_s = status_.moving && status_.follows ? command_.setpoint.feed_mm_s : 0;
    sample_.feed_actual_mm_s = report_.feed_mm_s;
    sample_.horizon = status_.follows ? mechanism_->follower.horizon() : Horizon{};
    fill_pose_set();
    sample_.pose_actual = report_.pose;
    sample_.position_set = report_.position_set;
    sample_.velocity_set = report_.velocity_set;
    sample_.acceleration_set = report_.acceleration_set;
    sample_.position = report_.position;
    sample_.answer_delay = report_.answer_delay;
    sample_.following_error = report_.following_error;
    sample_.truth = report_.truth;
    sample_.velocity = report_.velocity;
    sample_.effort = report_.effort;
    sample_.force = report_.force;
    sample_.contact = report_.contact;
    sample_.statusword = report_.statusword;
    sample_.error_code = report_.error_code;
    sample_.torque_permille = report_.torque_permille;
    sample_.ahead = report_.ahead;
    sample_.counts = report_.counts;
    std::copy(report_.spindle_rpm.begin(), report_.spindle_rpm.end(), sample_.spindle_rpm.begin());
    std::copy(report_.spindle_torque_nm.begin(), report_.spindle_torque_nm.end(), sample_.spindle_torque_nm.begin());
    sample_.inputs = report_.inputs;
    sample_.probe = report_.probe;
    sample_.outputs = command_.outputs;
    sample_.moves_done = status_.moves_done;
  }
  const auto kept = static_cast<std::int64_t>(link_.history.capacity());
  if (cycle_ - link_.delivered.load(std::memory_order_relaxed) > kept) ++sample_.samples_lost;
  link_.history.add(sample_);
  link_.status.write(status_);
}

}  // namespace rmac::gateway
