#pragma once

#include <string>

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Has a mechanism's drives hang on the models of their buses instead, where these are not simulated themselves. The
/// model of bus BUS is the bus BUS.model, of which the machine's interface has parameters (docs/simulated-bus.md).
/// Gives the first bus that has no model, and is then of no use; or nothing.
[[nodiscard]] std::string put_on_models(sdk::DeviceObject& device);

}  // namespace rmac::gateway
