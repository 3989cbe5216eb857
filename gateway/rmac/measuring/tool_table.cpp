#include "gateway/rmac/measuring/tool_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::cli {
namespace {

Result<nlohmann::json> find(const nlohmann::json& table, int number) {
  const auto& all = table.at("Tools");
  const auto tool = std::ranges::find_if(all, [&](const auto& entry) { return entry.at("ToolNumber") == number; });
  if (tool != all.end()) return *tool;
  return fail(fmt::format("tool {} is not in the tool table, so that it cannot be corrected there", number));
}

}  // namespace

Result<nlohmann::json> read_tools(Connection& connection) {
  return connection.call("RMAC_CAM.GetTools");
}

Result<nlohmann::json> read_tool(Connection& connection, int number) {
  const auto table = read_tools(connection);
  if (!table) return tl::unexpected(table.error());
  return find(*table, number);
}

Result<nlohmann::json> read_tool_in_spindle(Connection& connection) {
  const auto table = read_tools(connection);
  if (!table) return tl::unexpected(table.error());
  const auto& mounted = table->at("Mounted");
  if (mounted.is_number_integer() && mounted != 0) return find(*table, mounted.get<int>());
  return fail(
      "no tool of the tool table is in the spindle, so that nothing is known of the probe; enter it with `rmac "
      "tools set` and change to it");
}

Result<> set_tool(Connection& connection, const nlohmann::json& tool) {
  return connection.command("RMAC_CAM.SetTool", tool);
}

}  // namespace rmac::cli
