#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Whether a mechanism that is to be put in force is no more than what was verified: each joint's travel, speed,
/// acceleration and jerk within those of `verified`, and the same joints, kinematics and actuator map. An error names
/// the first that is more, and what was verified.
[[nodiscard]] Expected<> check_within_verified(const sdk::DeviceObject& wanted, const sdk::DeviceObject& verified);

/// Refuses joints whose travel, speed, acceleration or jerk is beyond that of the database's joint of the same name.
[[nodiscard]] Expected<> check_within_database(const sdk::DeviceObject& wanted, const sdk::DeviceObject& database);

}  // namespace rmac::gateway
