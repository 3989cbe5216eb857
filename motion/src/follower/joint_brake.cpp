#include "rmac/motion/follower/joint_brake.hpp"

#include <algorithm>

namespace rmac {

JointBrake::JointBrake(std::span<const JointLimits> joints) : profiles_(joints.size()) {
  for (const JointLimits& joint : joints) {
    bounds_.push_back(
        {-joint.max_speed, joint.max_speed, -joint.max_acceleration, joint.max_acceleration, joint.max_jerk});
  }
}

void JointBrake::begin(const Setpoint& from) noexcept {
  duration_ = 0;
  for (std::size_t j = 0; j < bounds_.size(); ++j) {
    profiles_[j] = velocity_profile({from.position[j], from.velocity[j], from.acceleration[j]}, 0, bounds_[j]);
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
