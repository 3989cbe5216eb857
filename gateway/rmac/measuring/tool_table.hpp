#pragma once

#include <nlohmann/json.hpp>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

namespace rmac::cli {

/// All tools, what is in the spindle and what is wanted there, as the wire has them.
[[nodiscard]] Result<nlohmann::json> read_tools(Connection& connection);
/// A tool of the table as the wire has it; an error where there is none of the number.
[[nodiscard]] Result<nlohmann::json> read_tool(Connection& connection, int number);
/// The one in the spindle; an error where it is empty, or nobody knows what is in it.
[[nodiscard]] Result<nlohmann::json> read_tool_in_spindle(Connection& connection);
/// Adds a tool, or replaces the one of its number. Needs motion authority.
[[nodiscard]] Result<> set_tool(Connection& connection, const nlohmann::json& tool);

}  // namespace rmac::cli
