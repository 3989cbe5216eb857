#include "servo/watch/torque_watch.hpp"

namespace rmac {

void TorqueWatch::step(FaultSink& faults) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const ServoActuator& actuator = actuators_[i];
    const DriveFeedback& words = actuator.bus->feedback[actuator.axis];
    const double measured_nm = words.torque_permille * actuator.scale.rated_torque_nm / 1000;
    if (!beyond_[i].step(measured_nm, actuator.max_torque_nm)) continue;
    faults.raise({ServoFault::Kind::TorqueBound, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), measured_nm,
                  actuator.max_torque_nm});
  }
}

void TorqueWatch::rest() noexcept {
  for (CyclesBeyond& beyond : beyond_) beyond.restart();
}

}  // namespace rmac
