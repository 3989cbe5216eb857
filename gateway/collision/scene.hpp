#pragma once

#include <vector>

#include "gateway/bodies/link_chain.hpp"
#include "gateway/collision/scene_body.hpp"
#include "gateway/collision/setup/setup.hpp"
#include "gateway/tools/tool.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// The bodies of a machine, and those of a set-up on its table, with their meshes read. Refused are meshes that are no
/// solids, and a part that the stock does not hold anything of. Errors name the body.
[[nodiscard]] Expected<std::vector<SceneBody>> scene_bodies(const MachineBodies& machine, const Setup& setup);

/// The bodies of a tool in the spindle; none for a tool without a shape.
[[nodiscard]] std::vector<SceneBody> tool_bodies(const Tool& tool, const LinkChain& chain, double clearance_mm);

}  // namespace rmac::gateway
