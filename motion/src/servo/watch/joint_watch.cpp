#include "servo/watch/joint_watch.hpp"

#include <cmath>
#include <optional>

namespace rmac {

namespace {

struct OneFault final : FaultSink {
  void raise(const ServoFault& fault) noexcept override { found = fault; }
  std::optional<ServoFault> found{};
};

}  // namespace

void JointWatch::raise(ServoFault::Kind kind, double value, double bound, FaultSink& faults) const noexcept {
  faults.raise({kind, ServoFault::Part::Joint, index_, value, bound});
}

bool JointWatch::comes_of_swing(const JumpSeen& jump) const noexcept {
  constexpr double kLittleMore = 2;
  const bool little = !jump.refused && std::abs(jump.jump) <= kLittleMore * joint_->bounds.jump;
  return oscillation_.swings() && (little || jump.shakes);
}

void JointWatch::step(const JointSeen& seen, FaultSink& faults) noexcept {
  const JointBounds& bounds = joint_->bounds;
  JumpSeen jump = seen.position;
  jump.trembles = oscillation_.trembles();
  jump.shakes = oscillation_.shakes();
  OneFault jumped;
  jumps_.step(jump, jumped);
  if (jumped.found) {
    if (comes_of_swing(jump)) oscillation_.raise(faults);
    faults.raise(*jumped.found);
  }
  watch_sensor(faults);
  if (seen.bounces) {
    oscillation_.rest();
  } else {
    oscillation_.step(seen.loop, faults);
  }
  response_.step({.effort = oscillation_.acted(),
                  .commanded = seen.commanded,
                  .position = seen.loop.position,
                  .position_set = seen.following_error + seen.loop.position,
                  .out_of_bound = std::abs(seen.following_error) > joint_->max_following_error,
                  .swings = oscillation_.swings(),
                  .answered = seen.answered},
                 faults);
  if (!(std::abs(seen.following_error) <= joint_->max_following_error)) {
    if (oscillation_.swings() && !response_.encoder_froze()) oscillation_.raise(faults);
    response_.name_error(seen.following_error, faults);
  }
  if (too_fast_.step(seen.velocity, bounds.velocity)) {
    if (oscillation_.swings()) oscillation_.raise(faults);
    raise(ServoFault::Kind::VelocityBound, seen.velocity, bounds.velocity, faults);
  }
  const bool by_force = joint_->method == ControlMethod::Force;
  // Where there is a sensor, it tells of a collision too.
  const double most = joint_->force.max_force;
  if ((by_force || (joint_->force_sensor && most > 0)) && !(std::abs(seen.force) <= most)) {
    raise(ServoFault::Kind::ForceLimit, seen.force, most, faults);
  }
  if (by_force) watch_contact(seen, faults);
}

void JointWatch::watch_sensor(FaultSink& faults) const noexcept {
  const auto& sensor = joint_->force_sensor;
  if (!sensor) return;
  const DriveFeedback& words = sensor->bus->feedback[sensor->axis];
  if (!words.online || !words.sensor_valid) raise(ServoFault::Kind::SensorLost, 0, 0, faults);
}

void JointWatch::watch_contact(const JointSeen& seen, FaultSink& faults) const noexcept {
  const ForceControl& control = joint_->force;
  if (seen.force_hangs) raise(ServoFault::Kind::SensorLost, seen.force, 0, faults);
  const JointBounds& bounds = joint_->bounds;
  const bool at_end = (seen.position_set > bounds.max_position && seen.velocity_set > 0) ||
                      (seen.position_set < bounds.min_position && seen.velocity_set < 0);
  const bool searching = seen.contact == ContactState::Approaching;
  if (at_end || (searching && seen.searched > control.max_search)) {
    raise(ServoFault::Kind::ContactLost, seen.searched, control.max_search, faults);
  }
}

}  // namespace rmac
