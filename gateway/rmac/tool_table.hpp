#pragma once

#include <nlohmann/json.hpp>

#include "gateway/rmac/connection.hpp"
#include "gateway/rmac/failure.hpp"

namespace rmac::cli {

/// A tool of the table as the wire has it; an error where there is none of the number.
[[nodiscard]] Result<nlohmann::json> read_tool(Connection& connection, int number);
/// The one in the spindle; an error where it is empty, or nobody knows what is in it.
[[nodiscard]] Result<nlohmann::json> read_tool_in_spindle(Connection& connection);

}  // namespace rmac::cli
