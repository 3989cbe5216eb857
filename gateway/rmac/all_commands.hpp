#pragma once

#include <span>

#include "gateway/rmac/commands/command.hpp"

namespace rmac::cli {

/// The commands of the client, in the order in which the help lists them.
[[nodiscard]] std::span<const Registration> all_commands();

}  // namespace rmac::cli
