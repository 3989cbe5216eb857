#include "servo/setpoint/setpoints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rmac {
namespace {

/// A part is soft that gives way by so much, mm or deg, when a joint pushes it with all it has.
constexpr double kSoft = 2;
constexpr double kAnything = std::numeric_limits<double>::infinity();

std::vector<MotionBounds> stop_bounds(std::span<const ServoJoint> joints) {
  constexpr double kAnySpeed = 1e9;  // it falls only
  std::vector<MotionBounds> result;
  for (const ServoJoint& joint : joints) {
    const double deceleration = joint.bounds.stop_deceleration;
    result.push_back({-kAnySpeed, kAnySpeed, -deceleration, deceleration, joint.bounds.stop_jerk});
  }
  return result;
}

}  // namespace

Setpoints::Setpoints(const ServoLoopParts& parts, const Wiring::Delays& delays, IndexSet follow_themselves)
    : joints_(parts.joints),
      kinematic_joints_(parts.kinematics->joint_count()),
      period_s_(parts.period_s),
      virtual_mode_(parts.virtual_mode),
      learned_(parts.joints, parts.period_s),
      brake_(stop_bounds(parts.joints)) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    followers_.emplace_back(joints_[j], period_s_, delays[j]);
    const double soft = has(follow_themselves, j) ? kAnything : joints_[j].max_effort / kSoft;
    force_loops_.emplace_back(joints_[j].force, period_s_, soft);
    ways_.push_back({RecentWay(delays[j]), RecentWay(delays[j])});
  }
  if (virtual_mode_) hold_at(parts.virtual_start);
}

void Setpoints::step(const Seen& seen, FaultSink& faults) noexcept {
  const auto before = position_;
  const auto velocity_before = velocity_;
  choose(seen, faults);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    note_way(j, before[j], velocity_before[j]);
    if (!has(seen.live, j)) ways_[j].forget();
  }
}

void Setpoints::note_way(std::size_t joint, double position_before, double velocity_before) noexcept {
  // What is wanted where it is has gone nowhere that it would have to follow.
  if (pushes(joint)) return ways_[joint].forget();
  ways_[joint].position.went(position_[joint] - position_before);
  ways_[joint].velocity.went(velocity_[joint] - velocity_before);
}

void Setpoints::choose(const Seen& seen, FaultSink& faults) noexcept {
  const IndexSet followed_before = std::exchange(on_the_way_, 0);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (by_force(j, seen.live)) {
      follow_force(j, seen);
    } else if (seen.follows && j < kinematic_joints_) {
      if (!follow(j, seen, has(followed_before, j), faults)) return;
    } else {
      if (!has(seen.live, j) && !virtual_mode_) position_[j] = seen.position[j];
      velocity_[j] = acceleration_[j] = 0;
    }
  }
}

bool Setpoints::follow(std::size_t joint, const Seen& seen, bool followed_before, FaultSink& faults) noexcept {
  const JointSetpoint planned{seen.plan.position[joint], seen.plan.velocity[joint], seen.plan.acceleration[joint]};
  if (!std::isfinite(planned.position) || !std::isfinite(planned.velocity) || !std::isfinite(planned.acceleration)) {
    faults.raise({ServoFault::Kind::NotANumber, ServoFault::Part::Joint, static_cast<std::uint32_t>(joint),
                  planned.position, 0});
    return false;
  }
  on_the_way_ |= only(joint);
  VelocityFollower& follower = followers_[joint];
  if (joints_[joint].method == ControlMethod::Velocity && has(seen.live, joint)) {
    if (!followed_before) follower.begin(position_[joint], planned.position);
    set(joint, follower.step(planned, position_[joint], seen.position[joint]));
  } else {
    follower.on_plan();
    set(joint, planned);
  }
  return true;
}

// A joint under force control is out of the plan: its setpoint goes where its force sends it.
void Setpoints::follow_force(std::size_t joint, const Seen& seen) noexcept {
  ForceLoop& loop = force_loops_[joint];
  const double wanted = seen.follows && std::isfinite(seen.wanted_force[joint]) ? seen.wanted_force[joint] : 0;
  const double effort = seen.effort[joint];
  const bool bounded = std::abs(effort) >= joints_[joint].max_effort;
  loop.step({.wanted = wanted,
             .measured = seen.force[joint],
             .position = seen.position[joint],
             .velocity = seen.velocity[joint],
             .bounded = bounded ? (effort > 0 ? 1 : -1) : 0});
  const double position = loop.pushes() ? seen.position[joint] : position_[joint] + loop.velocity() * period_s_;
  set(joint, {position, loop.velocity(), 0});
}

void Setpoints::brake(const Seen& seen) noexcept {
  on_the_way_ = 0;
  braked_s_ += period_s_;
  brake_.at(braked_s_, braking_);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const double before = position_[j], velocity_before = velocity_[j];
    if (by_force(j, seen.live)) {
      follow_force(j, seen);
    } else {
      set(j, {braking_.position[j], braking_.velocity[j], braking_.acceleration[j]});
    }
    note_way(j, before, velocity_before);
  }
}

void Setpoints::set(std::size_t joint, const JointSetpoint& wanted) noexcept {
  position_[joint] = wanted.position;
  velocity_[joint] = wanted.velocity;
  acceleration_[joint] = wanted.acceleration;
}

bool Setpoints::braked() const noexcept {
  const auto let_go = [](const ForceLoop& loop) { return !loop.pushes() && loop.velocity() == 0; };
  return braked_s_ >= brake_.duration() && std::ranges::all_of(force_loops_, let_go);
}

void Setpoints::begin_cycle() noexcept {
  for (Way& way : ways_) way.begin_cycle();
}

void Setpoints::hold_at(std::size_t joint, double position) noexcept {
  set(joint, {position, 0, 0});
  ways_[joint].forget();
}

void Setpoints::hold_at(std::span<const double> positions) noexcept {
  std::copy(positions.begin(), positions.end(), position_.begin());
  for (Way& way : ways_) way.forget();
}

void Setpoints::give_up(std::size_t joint) noexcept {
  velocity_[joint] = acceleration_[joint] = 0;
  force_loops_[joint].restart();
}

void Setpoints::let_go() noexcept {
  for (ForceLoop& loop : force_loops_) loop.restart();
}

void Setpoints::begin_braking() noexcept {
  braking_.position = position_;
  braking_.velocity = velocity_;
  braking_.acceleration = acceleration_;
  brake_.begin(braking_);
  braked_s_ = 0;
}

}  // namespace rmac
