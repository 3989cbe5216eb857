#include "servo/drives/shafts.hpp"

namespace rmac {

Shafts::Shafts(std::span<const ServoActuator> actuators, double period_s)
    : actuators_(actuators), loads_told_(!actuators.empty()) {
  for (const ServoActuator& actuator : actuators) {
    readers_.emplace_back(actuator.scale, period_s);
    loads_told_ = loads_told_ && actuator.bus->interface->tells_load(actuator.axis);
  }
}

void Shafts::read() noexcept {
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    readers_[i].read(actuators_[i].bus->feedback[actuators_[i].axis]);
    show(i);
  }
}

std::optional<std::array<double, kMaxJoints>> Shafts::loads_rad() const noexcept {
  if (!loads_told_) return std::nullopt;
  std::array<double, kMaxJoints> rad{};
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    rad[i] = readers_[i].rad_at(actuators_[i].bus->feedback[actuators_[i].axis].load_counts);
  }
  return rad;
}

}  // namespace rmac
