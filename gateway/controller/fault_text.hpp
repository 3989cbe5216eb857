#pragma once

#include <string>

#include "gateway/controller/servo_link.hpp"

namespace rmac::gateway {

/// A fault in words: what happened, where, and what to do. `device` names joints; nullptr when its mechanism is gone.
[[nodiscard]] std::string describe(const ServoFault& fault, const sdk::DeviceObject* device);

}  // namespace rmac::gateway
