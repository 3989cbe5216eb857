#include "gateway/verifier/axis_models.hpp"

#include "gateway/buses/bus_choice.hpp"

namespace rmac::verifier {

std::string put_on_models(sdk::DeviceObject& device) {
  std::string without;
  const auto is_simulated = [&](const std::string& bus) {
    return gateway::interface_of_bus(bus, device.digital_control_interface).name == "SimulatedInterface";
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
  for (auto* joints : {&device.joints, &device.held_joints}) {
    for (sdk::Joint& joint : *joints) {
      if (joint.force_sensor) put(joint.force_sensor->bus);
    }
  }
  return without;
}

}  // namespace rmac::verifier
