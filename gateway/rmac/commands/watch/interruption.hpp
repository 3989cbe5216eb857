#pragma once

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Handles what arrives until Ctrl-C, which is how a person ends watching, not a failure.
[[nodiscard]] Result<> wait_until_interrupted(Connection& connection);

}  // namespace rmac::cli
