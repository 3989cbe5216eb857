#include "rmac/motion/follower/joint_brake.hpp"

#include <algorithm>
#include <utility>

namespace rmac {

namespace {

std::vector<MotionBounds> bounds_of(std::span<const JointLimits> joints) {
  std::vector<MotionBounds> bounds;
  for (const JointLimits& joint : joints) {
    bounds.push_back(
        {-joint.max_speed, joint.max_speed, -joint.max_acceleration, joint.max_acceleration, joint.max_jerk});
  }
  return bounds;
}

}  // namespace

JointBrake::JointBrake(std::span<const JointLimits> joints) : JointBrake(bounds_of(joints)) {}
JointBrake::JointBrake(std::vector<MotionBounds> bounds) : bounds_(std::move(bounds)), profiles_(bounds_.size()) {}

void JointBrake::begin(const Setpoint& from) noexcept {
  duration_ = 0;
  for (std::size_t j = 0; j < bounds_.size(); ++j) {
    const bool is_bounded = bounds_[j].max_acceleration > 0 && bounds_[j].max_jerk > 0;
    profiles_[j] = is_bounded
                       ? velocity_profile({from.position[j], from.velocity[j], from.acceleration[j]}, 0, bounds_[j])
                       : JerkProfile({from.position[j], 0, 0});
    duration_ = std::max(duration_, profiles_[j].duration());
  }
}

void JointBrake::at(double t, Setpoint& setpoint) const noexcept {
  for (std::size_t j = 0; j < profiles_.size(); ++j) {
    const JointState state = profiles_[j].at(t);
    const bool stands = t >= profiles_[j].duration();
    setpoint.position[j] = state.position;
    setpoint.velocity[j] = stands ? 0 : state.velocity;
    setpoint.acceleration[j] = stands ? 0 : state.acceleration;
  }
}

}  // namespace rmac
