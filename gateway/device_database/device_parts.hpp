#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

// The parts of a `device.json`, from a document that the schema has passed.

/// `{"Module": …, "Parameters": {…}}`.
[[nodiscard]] sdk::ModuleChoice module_choice(const nlohmann::json& object);
[[nodiscard]] std::vector<sdk::Joint> joints(const nlohmann::json& list);
/// Without the inputs of their drives.
[[nodiscard]] std::vector<sdk::Actuator> actuators(const nlohmann::json& list);
[[nodiscard]] std::vector<sdk::Spindle> spindles(const nlohmann::json& list);

// The same of what has passed no schema yet: what is wrong is told by its JSON pointer.

/// What stands under `Parameters`.
[[nodiscard]] Expected<> read_parameters(const nlohmann::json& parameters, sdk::ModuleChoice& choice);
/// Lists of which an entry may leave out what the one of its number in `present` has.
[[nodiscard]] Expected<std::vector<sdk::Actuator>> read_actuators(const nlohmann::json& list,
                                                                  const std::vector<sdk::Actuator>& present);
[[nodiscard]] Expected<std::vector<sdk::Spindle>> read_spindles(const nlohmann::json& list,
                                                                const std::vector<sdk::Spindle>& present);
/// What stands under `Resonances` of a joint.
[[nodiscard]] Expected<std::vector<Resonance>> read_resonances(const nlohmann::json& list);

}  // namespace rmac::gateway
