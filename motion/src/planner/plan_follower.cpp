#include "rmac/motion/plan_follower.hpp"

#include <algorithm>

#include "rmac/motion/plan.hpp"

namespace rmac {
namespace {

/// Two path lengths nearer than this are the same place: far below a setpoint's resolution, far above rounding.
constexpr double kSamePlace = 1e-7;

}  // namespace

PlanFollower::PlanFollower(PlanChannel& channel, std::size_t joint_count, double period_s) noexcept
    : channel_(channel), joint_count_(joint_count), period_s_(period_s) {}

void PlanFollower::hold_at(std::span<const double> joints) noexcept {
  std::copy_n(joints.begin(), joint_count_, held_.position.begin());
}

void PlanFollower::retire(const Plan* plan) noexcept {
  // The planner publishes one plan at a time and drains this ring before each, so there is always room.
  if (plan != nullptr) (void)channel_.retired.push(plan);
}

void PlanFollower::activate(const Plan* plan) noexcept {
  retire(active_);
  active_ = plan;
  counted_s_ -= plan->origin_mm - origin_mm_;
  origin_mm_ = plan->origin_mm;
  piece_ = 0;
  segment_ = 0;
}

void PlanFollower::receive(std::int64_t cycle) noexcept {
  const Plan* plan = nullptr;
  while (channel_.published.pop(plan)) {
    if (cycle > plan->latest_cycle) {
      last_refused_ = plan->id;
      retire(plan);
      continue;
    }
    accepted_ = plan->id;
    retire(next_);
    next_ = plan;
  }
  if (next_ != nullptr && cycle >= next_->start_cycle) {
    activate(next_);
    next_ = nullptr;
  }
}

std::uint32_t PlanFollower::count_done(double s) noexcept {
  std::uint32_t done = 0;
  for (std::size_t i = segment_; i < active_->segments.size(); ++i) {
    const double start = active_->segment_start[i];
    if (start > s) break;
    done += active_->segments[i]->moves_ended(counted_s_ + kSamePlace - start, s + kSamePlace - start);
  }
  counted_s_ = std::max(counted_s_, s);
  return done;
}

void PlanFollower::follow(double t, Setpoint& setpoint) noexcept {
  const Plan& plan = *active_;
  while (piece_ + 1 < plan.law.size() && t >= plan.law[piece_ + 1].t0) ++piece_;
  const LawPiece& piece = plan.law[piece_];
  const bool ended = t >= plan.end_time_s;
  PathState at = piece.at(std::clamp(t - piece.t0, 0.0, piece.duration));
  if (ended) at.v = at.a = 0;

  setpoint.moves_done = count_done(at.s);
  while (segment_ + 1 < plan.segments.size() && at.s >= plan.segment_start[segment_ + 1]) ++segment_;
  const PathSegment& segment = *plan.segments[segment_];
  const double local = std::clamp(at.s - plan.segment_start[segment_], 0.0, segment.length());
  JointPoint point;
  // Every point of a published plan was evaluated when the plan was checked; should one fail all the same, the last
  // setpoint stays, and the servo loop's following-error bound sees to the rest.
  if (segment.evaluate(local, 2, 1, point) != KinematicsStatus::Ok) {
    setpoint = held_;
    return;
  }
  for (std::size_t j = 0; j < joint_count_; ++j) {
    setpoint.position[j] = point.d[0][j];
    setpoint.velocity[j] = point.d[1][j] * at.v;
    setpoint.acceleration[j] = point.d[2][j] * at.v * at.v + point.d[1][j] * at.a;
  }
  setpoint.pose = segment.pose(local);
  const MoveStretch& stretch = segment.stretch_at(local);
  setpoint.move_id = stretch.move_id;
  setpoint.s_mm = stretch.s_begin_mm + stretch.s_per_length * (local - stretch.begin);
  setpoint.feed_mm_s = at.v;
  setpoint.moving = !ended;
  held_ = setpoint;
  held_.moves_done = 0;
  held_.moving = false;
  held_.feed_mm_s = 0;
  held_.velocity.fill(0);
  held_.acceleration.fill(0);
}

void PlanFollower::sample(std::int64_t cycle, Setpoint& setpoint) noexcept {
  receive(cycle);
  if (active_ == nullptr) {
    setpoint = held_;
    return;
  }
  follow(static_cast<double>(cycle - active_->start_cycle) * period_s_, setpoint);
}

}  // namespace rmac
