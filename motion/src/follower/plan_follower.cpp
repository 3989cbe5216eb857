#include "rmac/motion/follower/plan_follower.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rmac/motion/plan.hpp"

namespace rmac {
namespace {

/// Two path lengths nearer than this are the same place: far below a setpoint's resolution, far above rounding.
constexpr double kSamePlace = 1e-7;
/// A joint's velocity may change by so much of what its acceleration allows; plans keep to less.
constexpr double kStep = 1.1;
/// And its position may miss what the velocities before and after make of it by so much of the same.
constexpr double kMiss = 0.5;
/// mm or degrees: what kinematics that iterate leave; likewise in velocities.
constexpr double kRounding = 1e-5;

/// Without motion, at the same place.
void stand(Setpoint& setpoint) noexcept {
  setpoint.moves_done = 0;
  setpoint.moving = false;
  setpoint.feed_mm_s = 0;
  setpoint.velocity.fill(0);
  setpoint.acceleration.fill(0);
}

bool is_number(const Setpoint& setpoint, std::size_t joint) noexcept {
  return std::isfinite(setpoint.position[joint]) && std::isfinite(setpoint.velocity[joint]) &&
         std::isfinite(setpoint.acceleration[joint]);
}

/// The joint could be at `next` a period after it was at `before`.
bool goes_on(const Setpoint& before, const Setpoint& next, std::size_t joint, double most, double period_s) noexcept {
  const double v0 = before.velocity[joint], v1 = next.velocity[joint];
  const double way = next.position[joint] - before.position[joint];
  return std::abs(v1 - v0) <= kStep * most * period_s + kRounding &&
         std::abs(way - 0.5 * (v0 + v1) * period_s) <= kMiss * most * period_s * period_s + kRounding;
}

}  // namespace

PlanFollower::PlanFollower(PlanChannel& channel, std::span<const JointLimits> joints, double period_s)
    : channel_(channel),
      joints_(joints.begin(), joints.end()),
      brake_(joints),
      period_s_(period_s),
      horizon_(period_s) {}

void PlanFollower::hold_at(std::span<const double> joints) noexcept {
  std::copy_n(joints.begin(), joints_.size(), last_.position.begin());
  stand(last_);
  placed_ = true;
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
  off_path_ = false;
  rests_s_ = plan->law.empty() ? counted_s_ : plan->law.back().at(plan->law.back().duration).s;
}

void PlanFollower::receive(std::int64_t cycle) noexcept {
  const Plan* plan = nullptr;
  while (channel_.published.pop(plan)) {
    if (plan->departures != departure_.count) {  // it continues a path that is not followed any more
      retire(plan);
      continue;
    }
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

bool PlanFollower::place(const PathSegment& segment, double s, const PathState& at, Setpoint& setpoint) noexcept {
  JointPoint point;
  if (segment.evaluate(s, 2, 1, point) != KinematicsStatus::Ok) {
    depart(PathDeparture::Cause::NoSolution, 0);
    return false;
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    setpoint.position[j] = point.d[0][j];
    setpoint.velocity[j] = point.d[1][j] * at.v;
    setpoint.acceleration[j] = point.d[2][j] * at.v * at.v + point.d[1][j] * at.a;
    if (!is_number(setpoint, j)) {
      depart(PathDeparture::Cause::NotANumber, j);
      return false;
    }
    if (!placed_ && !goes_on(last_, setpoint, j, joints_[j].max_acceleration, period_s_)) {
      depart(PathDeparture::Cause::Jump, j);
      return false;
    }
  }
  return true;
}

void PlanFollower::follow(std::int64_t cycle, Setpoint& setpoint) noexcept {
  const Plan& plan = *active_;
  const double t = static_cast<double>(cycle - plan.start_cycle) * period_s_;
  while (piece_ + 1 < plan.law.size() && t >= plan.law[piece_ + 1].t0) ++piece_;
  const LawPiece& piece = plan.law[piece_];
  const bool ended = t >= plan.end_time_s;
  PathState at = piece.at(std::clamp(t - piece.t0, 0.0, piece.duration));
  if (ended) at.v = at.a = 0;

  std::size_t segment = segment_;
  while (segment + 1 < plan.segments.size() && at.s >= plan.segment_start[segment + 1]) ++segment;
  const PathSegment& on = *plan.segments[segment];
  const double local = std::clamp(at.s - plan.segment_start[segment], 0.0, on.length());
  // Every point of a published plan was evaluated when the plan was checked; kinematics that answer otherwise now are
  // not to be followed.
  if (!place(on, local, at, setpoint)) {
    brake(cycle, setpoint);
    return;
  }
  // What ends where the machine comes to rest is done when it rests, not the few cycles before in which it is as good
  // as there: who was told that the last move is done may ask for what needs rest.
  setpoint.moves_done = count_done(ended ? at.s : std::min(at.s, rests_s_ - 2 * kSamePlace));
  segment_ = segment;
  setpoint.pose = on.pose(local);
  const MoveStretch& stretch = on.stretch_at(local);
  setpoint.move_id = stretch.move_id;
  setpoint.s_mm = stretch.s_begin_mm + stretch.s_per_length * (local - stretch.begin);
  setpoint.feed_mm_s = at.v;
  setpoint.moving = !ended;
  last_ = setpoint;
  placed_ = false;
}

/// The motion under way ends as the planner was told to end it.
bool PlanFollower::stops() const noexcept {
  const std::uint64_t first = channel_.stopping.load(std::memory_order_acquire);
  return active_ != nullptr && first != 0 && active_->id >= first;
}

void PlanFollower::depart(PathDeparture::Cause cause, std::size_t joint) noexcept {
  departure_ = {departure_.count + 1, active_->id, cycle_, cause, static_cast<std::uint32_t>(joint)};
  off_path_ = true;
  retire(next_);
  next_ = nullptr;
  brake_.begin(last_);
}

void PlanFollower::brake(std::int64_t cycle, Setpoint& setpoint) noexcept {
  if (placed_) {
    setpoint = last_;
    return;
  }
  const double t = static_cast<double>(cycle - departure_.cycle) * period_s_;
  brake_.at(t, last_);
  last_.moves_done = 0;
  last_.feed_mm_s = 0;
  last_.moving = t < brake_.duration();
  setpoint = last_;
}

/// What there is of a horizon, and what the planner says of it.
Horizon PlanFollower::planned() const noexcept {
  if (off_path_ && last_.moving) {
    const double t = static_cast<double>(cycle_ - departure_.cycle) * period_s_;
    return {std::max(brake_.duration() - t, 0.0), HorizonLimit::Stop};
  }
  const Plan* const newest = off_path_ ? nullptr : next_ != nullptr ? next_ : active_;
  if (newest == nullptr) return {0, channel_.horizon.of(0, HorizonLimit::Stop)};
  const double t = static_cast<double>(cycle_ - newest->start_cycle) * period_s_;
  return {std::max(newest->end_time_s - t, 0.0), channel_.horizon.of(newest->id, newest->limit)};
}

void PlanFollower::sample(std::int64_t cycle, Setpoint& setpoint) noexcept {
  receive(cycle);
  if (std::exchange(leaves_, false) && last_.moving && !off_path_ && !stops()) depart(PathDeparture::Cause::Stop, 0);
  if (active_ == nullptr) {
    setpoint = last_;
  } else if (off_path_) {
    brake(cycle, setpoint);
  } else {
    follow(cycle, setpoint);
  }
  cycle_ = cycle;
  horizon_.step(cycle, planned());
}

}  // namespace rmac
