#include "servo/joints/wiring.hpp"

#include <algorithm>

namespace rmac {

Wiring::Wiring(const ActuatorMap& map, std::size_t joints, std::span<const ServoActuator> actuators)
    : joints_(joints), actuators_(actuators.size()) {
  for (std::size_t i = 0; i < actuators_; ++i) {
    if (actuators[i].mode == DriveMode::CyclicSyncTorque) torque_drives_ |= only(i);
    const int delay = actuators[i].bus->interface->answer_delay(actuators[i].axis);
    actuator_delays_[i] = static_cast<std::uint8_t>(std::clamp(delay, 0, kMostAnswerDelay));
  }
  const std::array<double, kMaxJoints> home{};
  IndexSet reached = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    std::array<double, kMaxJoints> effort{}, torques{};
    effort[j] = 1;
    map.actuator_efforts({home.data(), joints_}, {effort.data(), joints_}, {torques.data(), actuators_});
    for (std::size_t i = 0; i < actuators_; ++i) {
      if (torques[i] == 0) continue;
      actuators_of_[j] |= only(i);
      joint_of_[i] = static_cast<std::uint8_t>(j);
      sense_[i] = static_cast<std::int8_t>(has(reached, i) ? 0 : torques[i] > 0 ? 1 : -1);
      joint_delays_[j] = std::max(joint_delays_[j], actuator_delays_[i]);
      reached |= only(i);
    }
  }
}

IndexSet Wiring::joints_of(IndexSet actuators) const noexcept {
  IndexSet joints = 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    if ((actuators_of_[j] & actuators) != 0) joints |= only(j);
  }
  return joints;
}

IndexSet Wiring::actuators_within(IndexSet joints) const noexcept {
  IndexSet actuators = first(actuators_);
  for (std::size_t j = 0; j < joints_; ++j) {
    if (!has(joints, j)) actuators &= ~actuators_of_[j];
  }
  return actuators;
}

}  // namespace rmac
