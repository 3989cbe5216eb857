#pragma once

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

/// Where the part lies in the machine frame.
[[nodiscard]] Result<Frame> read_part_frame(Connection& connection);
/// Puts it there. Needs motion authority, at rest.
[[nodiscard]] Result<> set_part_frame(Connection& connection, const Frame& frame);

}  // namespace rmac::cli
