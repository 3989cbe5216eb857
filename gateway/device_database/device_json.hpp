#pragma once

#include <nlohmann/json.hpp>

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The `device.json` that reads as this device object; whether it makes sense is the reader's to say. Without a
/// MechanismID, which is the device driver database's.
[[nodiscard]] nlohmann::json to_device_json(const sdk::DeviceObject& device);

/// Its lists of `Actuators` and `Spindles` alone; without the inputs of the actuators' drives.
[[nodiscard]] nlohmann::json to_json(const std::vector<sdk::Actuator>& actuators);
[[nodiscard]] nlohmann::json to_json(const std::vector<sdk::Spindle>& spindles);

}  // namespace rmac::gateway
