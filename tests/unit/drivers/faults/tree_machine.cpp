#include "tree_machine.hpp"

#include <stdexcept>

#include "gateway/buses/simulated_bus.hpp"
#include "gateway/device_database/device_database.hpp"
#include "gateway/mechanism/assembler.hpp"
#include "places.hpp"

namespace rmac::fault_test {

namespace {

template <typename T>
T made(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

TreeMachine::TreeMachine(const std::string& folder) : folder_(folder) {
  sdk::DeviceObject device = made(gateway::read_device_database(RMAC_SOURCE_DIR "/drivers/" + folder + "/device.json"));
  device.digital_io_interface = {};
  device.outputs.clear();
  device.inputs.clear();
  const sdk::ModuleChoice bus = device.digital_control_interface;
  axes_ = made(gateway::simulated_axes(bus));
  answer_delay_ = made(gateway::simulated_answer_delay(bus));
  registry_.add_control_interface(bus.name, [this](const auto&, const auto&, const auto&) {
    auto interface = std::make_shared<fieldbus::SimulatedInterface>(axes_, 0.001);
    interface->set_answer_delay(answer_delay_);
    return Expected<std::shared_ptr<DigitalControlInterface>>(std::move(interface));
  });
  const std::string built = RMAC_BINARY_DIR "/drivers/";
  mechanism_ = made(gateway::assemble(
      device, {}, gateway::ModuleLoader({built + folder, built + "modules"}, gateway::ModuleLoader::Opens::Whichever),
      registry_));
  std::size_t used = 0;
  for (const sdk::Actuator& actuator : device.actuators) used = std::max<std::size_t>(used, actuator.axis + 1);
  for (const sdk::Spindle& spindle : device.spindles) used = std::max<std::size_t>(used, spindle.axis + 1);
  axes_.resize(used, fieldbus::AxisPlantParameters{});
}

JointDrive TreeMachine::drive_of(std::size_t joint) const {
  const std::size_t count = parts().joints.size();
  std::array<double, kMaxJoints> shafts{}, joints{}, efforts{}, torques{};
  shafts[joint] = efforts[joint] = 1;
  parts().actuator_map->joint_positions({shafts.data(), count}, {joints.data(), count});
  const double mm = joints[joint];
  joints.fill(0);
  parts().actuator_map->actuator_efforts({joints.data(), count}, {efforts.data(), count}, {torques.data(), count});
  return {parts().actuators[joint].axis, mm, torques[joint], parts().joints[joint].max_following_error,
          parts().joints[joint].max_effort};
}

}  // namespace rmac::fault_test
