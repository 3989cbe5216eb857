#pragma once

#include <filesystem>
#include <string>

#include "gateway/bodies/body.hpp"
#include "gateway/bodies/link_chain.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// A machine whose shape is known, and how its links move.
struct ShapedMachine {
  std::string name;
  gateway::MachineBodies bodies;
  gateway::LinkChain chain;
};

/// `machine`: a name in the device tree, or the path of a device.json. Refused, with the file and `without`
/// ("collisions cannot be checked"), where nothing is said of its shape.
[[nodiscard]] Result<ShapedMachine> read_shaped_machine(const std::string& machine,
                                                        const std::filesystem::path& device_tree, const char* without);

}  // namespace rmac::cli
