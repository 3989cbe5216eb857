#include "servo/drives/shafts.hpp"

namespace rmac {

Shafts::Shafts(std::span<const ServoActuator> actuators, double period_s) : actuators_(actuators) {
  for (const ServoActuator& actuator : actuators) readers_.emplace_back(actuator.scale, period_s);
}

void Shafts::read() noexcept {
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    readers_[i].read(actuators_[i].bus->feedback[actuators_[i].axis]);
    show(i);
  }
}

}  // namespace rmac
