#pragma once

#include <memory>

#include "gateway/buses/touch_probe_model.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// A `SimulatedIOInterface` from its parameters (docs/simulated-bus.md). An error names the parameter and what it
/// takes.
[[nodiscard]] Expected<std::shared_ptr<fieldbus::SimulatedIoInterface>> make_simulated_io(
    const sdk::ModuleChoice& choice);

/// `io` with its probe on the mechanism of `parts`, when it is simulated and has one; otherwise `io` itself. Every
/// actuator must be on a simulated bus then.
[[nodiscard]] Expected<std::shared_ptr<DigitalIoInterface>> with_touch_probe(std::shared_ptr<DigitalIoInterface> io,
                                                                             const ServoLoopParts& parts);

}  // namespace rmac::gateway
