#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "rmac/motion/planner_model.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "tl/expected.hpp"

namespace rmac::bench {

/// The kinematics that a device.json names, with its parameters, from the module that was built: one of the mechanism's
/// `folder` (relative to the device tree), or a shared one.
[[nodiscard]] tl::expected<std::shared_ptr<const Kinematics>, std::string> kinematics_of(const nlohmann::json& device,
                                                                                         const std::string& folder);

/// A mechanism of the device tree as the planner sees it.
[[nodiscard]] tl::expected<PlannerModel, std::string> model_of(const std::string& folder);

}  // namespace rmac::bench
