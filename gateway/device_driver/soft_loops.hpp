#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The device with loops that are softer `factor` times (above 1), for commissioning: where its gains swing at a
/// resonance, or were made for another mass. Of each joint whose law is a PID, alone or ahead of feedforward (three
/// gains or seven), Kp and Kd are divided by `factor`, Ki by its square; the joint speeds up at a quarter of its
/// acceleration, and may fall behind four times as far, 10 mm or degrees at most, or as far as it may already. Refuses
/// an overlay, whose loops are those of the machine below, and a device without such a joint.
[[nodiscard]] Expected<sdk::DeviceObject> softened(const sdk::DeviceObject& device, double factor);

}  // namespace rmac::gateway
