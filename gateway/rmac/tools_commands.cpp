#include <fmt/format.h>

#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

namespace {

std::string spindle_tool(const nlohmann::json& mounted) {
  if (mounted.is_null()) return "not known: look, and say it with rmac confirm NUMBER";
  return mounted == 0 ? "empty" : fmt::format("tool {}", mounted.dump());
}

/// Needs the lease: while another client has it, the machine is its.
Result<> edit(Connection& connection, const std::string& method, const nlohmann::json& params) {
  return with_authority(connection, [&]() -> Result<> {
    const auto answer = connection.call(method, params);
    return answer ? Result<>() : tl::unexpected(answer.error());
  });
}

}  // namespace

Result<> list_tools(Connection& connection, bool json) {
  const auto answer = connection.call("RMAC_CAM.GetTools");
  if (!answer) return tl::unexpected(answer.error());
  if (json) {
    fmt::print("{}\n", answer->dump());
    return {};
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& tool : answer->at("Tools")) {
    const auto bound = [&](const char* key) {
      const double value = tool.at(key);
      return value > 0 ? number(value) : std::string("-");
    };
    const auto& frame = tool.at("Frame");
    const bool straight = frame.at("p") == nlohmann::json{0.0, 0.0, 0.0} && frame.at("q").at(0) == 1.0;
    rows.push_back({tool.at("ToolNumber").dump(), tool.at("Name").get<std::string>(), number(tool.at("Length"), 4),
                    number(tool.at("Radius"), 4), bound("MaxRPM"), bound("MaxTorque"),
                    tool.at("NeedsSpindle").get<bool>() ? "yes" : "no", straight ? "no" : "yes"});
  }
  fmt::print("{}", table({"tool", "name", "length mm", "radius mm", "rpm at most", "N·m at most", "needs spindle",
                          "set off or turned"},
                         rows));
  fmt::print("\nspindle: {}\n", spindle_tool(answer->at("Mounted")));
  if (const auto prompt = answer->value("Prompt", ""); !prompt.empty()) fmt::print("to do: {}\n", prompt);
  return {};
}

Result<> set_tool(Connection& connection, const ToolRequest& request) {
  // What is not said stays as it is.
  const auto answer = connection.call("RMAC_CAM.GetTools");
  if (!answer) return tl::unexpected(answer.error());
  nlohmann::json tool;
  for (const auto& known : answer->at("Tools")) {
    if (known.at("ToolNumber") == request.number) tool = known;
  }
  if (tool.is_null() && !request.length_mm) {
    return fail(fmt::format("tool {} is new: give its --length", request.number));
  }
  tool["ToolNumber"] = request.number;
  if (request.length_mm) tool["Length"] = *request.length_mm;
  if (request.radius_mm) tool["Radius"] = *request.radius_mm;
  if (request.name) tool["Name"] = *request.name;
  if (request.max_rpm) tool["MaxRPM"] = *request.max_rpm;
  if (request.max_torque_nm) tool["MaxTorque"] = *request.max_torque_nm;
  if (request.needs_spindle) tool["NeedsSpindle"] = *request.needs_spindle;
  if (!request.frame.empty()) {
    const auto& f = request.frame;
    tool["Frame"] = {{"p", {f[0], f[1], f[2]}}, {"q", {f[3], f[4], f[5], f[6]}}};
  }
  return edit(connection, "RMAC_CAM.SetTool", tool);
}

Result<> remove_tool(Connection& connection, int number) {
  return edit(connection, "RMAC_CAM.RemoveTool", {{"ToolNumber", number}});
}

Result<> confirm_tool(Connection& connection, std::optional<int> number) {
  if (!number) {
    const auto answer = connection.call("RMAC_CAM.GetTools");
    if (!answer) return tl::unexpected(answer.error());
    if (answer->at("Wanted").is_null()) {
      return fail("no tool change is under way; to say which tool is in the spindle, give its number");
    }
    number = answer->at("Wanted").get<int>();
  }
  const auto confirmed = connection.call("RMAC_CAM.ConfirmToolChange", {{"ToolNumber", *number}});
  return confirmed ? Result<>() : tl::unexpected(confirmed.error());
}

}  // namespace rmac::cli
