#pragma once

#include <set>
#include <string>

#include "rmac/sdk/device_object.hpp"

namespace rmac::sdk {

/// The buses that a machine's drives and force sensors are on.
[[nodiscard]] inline std::set<std::string> buses_of(const DeviceObject& device) {
  std::set<std::string> names;
  for (const Actuator& actuator : device.actuators) names.insert(actuator.bus);
  for (const Spindle& spindle : device.spindles) names.insert(spindle.bus);
  for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
    if (const auto& sensor = joint_at(device, j).force_sensor) names.insert(sensor->bus);
  }
  return names;
}

}  // namespace rmac::sdk
