#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Whether a mechanism that is to be put in force is no more than what was verified: each joint's travel, speed,
/// acceleration and jerk within those of `verified`, and the same joints, kinematics and actuator map. An error names
/// the first that is more, what was verified, and how to have more.
[[nodiscard]] Expected<> check_within_verified(const sdk::DeviceObject& wanted, const sdk::DeviceObject& verified);

}  // namespace rmac::gateway
