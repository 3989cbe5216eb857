#include "gateway/dynamics/axis_models.hpp"

#include "gateway/buses/bus_choice.hpp"

namespace rmac::gateway {

std::string put_on_models(sdk::DeviceObject& device) {
  std::string without;
  const auto is_simulated = [&](const std::string& bus) {
    return interface_of_bus(bus, device.digital_control_interface).name == "SimulatedInterface";
  };
  const auto put = [&](std::string& bus) {
    if (is_simulated(bus)) return;
    const std::string model = bus + ".model";
    // A bus that says nothing of itself is the machine's own interface's, which may be a simulated one.
    if (device.digital_control_interface.texts.contains(model + ".interface") && is_simulated(model)) {
      bus = model;
    } else if (without.empty()) {
      without = bus;
    }
  };
  for (sdk::Actuator& actuator : device.actuators) put(actuator.bus);
  for (sdk::Spindle& spindle : device.spindles) put(spindle.bus);
  for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
    if (auto& sensor = sdk::joint_at(device, j).force_sensor) put(sensor->bus);
  }
  return without;
}

}  // namespace rmac::gateway
