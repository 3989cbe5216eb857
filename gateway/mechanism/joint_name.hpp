#pragma once

#include <string>

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// "joint 1 (Y)", "held joint 2 (Z)": a joint as people know it, who count those that a mechanism moves. Without a
/// device, one of a mechanism that is gone.
[[nodiscard]] std::string joint_name(std::size_t index, const sdk::DeviceObject* device);

}  // namespace rmac::gateway
