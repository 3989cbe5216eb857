#pragma once

#include <optional>
#include <vector>

#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// The axes of a `SimulatedInterface`, from its parameters: those of the example machines, or what `device.json` says
/// of them (docs/simulated-bus.md). An error names the parameter and what it takes.
[[nodiscard]] Expected<std::vector<fieldbus::SimulatedAxis>> simulated_axes(const sdk::ModuleChoice& choice);

/// How many cycles old its answers are: one as on CAN.
[[nodiscard]] Expected<int> simulated_answer_delay(const sdk::ModuleChoice& choice);

/// The part under the tool that the parameters describe, if any.
[[nodiscard]] Expected<std::optional<fieldbus::SimulatedContact>> simulated_contact(const sdk::ModuleChoice& choice);

}  // namespace rmac::gateway
