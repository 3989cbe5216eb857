#pragma once

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The device with loops that are softer `factor` times, for commissioning: where its gains swing at a resonance, or
/// were made for another mass. Of each joint whose law is a PID, alone or ahead of feedforward (three gains or seven),
/// Kp and Kd are divided by `factor`, Ki by its square; the joint speeds up at a quarter of its acceleration, and may
/// fall behind by half of `factor` times its bound.
[[nodiscard]] sdk::DeviceObject softened(const sdk::DeviceObject& device, double factor);

}  // namespace rmac::gateway
