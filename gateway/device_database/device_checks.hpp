#pragma once

#include <string>

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// What a schema cannot say: relations between the values of a `device.json`. Empty when they make sense, otherwise the
/// first mistake with its JSON pointer, value and what is allowed.
[[nodiscard]] std::string check_sense(const sdk::DeviceObject& device);

}  // namespace rmac::gateway
