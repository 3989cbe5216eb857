#pragma once

#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// Starts a motion of its own with the lease, and stays until it is over. Ctrl-C stops it.
[[nodiscard]] Result<> move_and_wait(Connection& connection, const std::string& method,
                                     const nlohmann::json& params = nlohmann::json::object());

}  // namespace rmac::cli
