#include "servo/drives/shaft_torques.hpp"

#include <cmath>

namespace rmac {

void ShaftTorques::make(std::span<const double> joints, std::span<const double> efforts, FaultSink& faults) noexcept {
  map_.actuator_efforts(joints, efforts, {torque_.data(), actuators_});
  for (std::size_t i = 0; i < actuators_; ++i) {
    if (std::isfinite(torque_[i])) continue;
    faults.raise(
        {ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), torque_[i], 0});
    let_go();
    return;
  }
}

}  // namespace rmac
