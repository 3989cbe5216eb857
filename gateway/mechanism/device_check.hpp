#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Checks a device object as a whole, whatever its modules are: counts, names, limits, bounds, bus axes, I/O bits. The
/// error names the joint, actuator or spindle, the value, and what would be right.
[[nodiscard]] Expected<> check_device(const sdk::DeviceObject& device);

}  // namespace rmac::gateway
