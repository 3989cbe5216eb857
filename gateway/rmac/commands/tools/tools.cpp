#include <fmt/format.h>

#include <algorithm>

#include "gateway/rmac/commands/tools/registrations.hpp"
#include "gateway/rmac/measuring/tool_table.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/authority.hpp"

namespace rmac::cli {

namespace {

/// A tool of the table as it is to be; of a tool that is there, what is not given stays.
struct Wanted {
  int number = 1;
  std::optional<double> length_mm, radius_mm, max_rpm, max_torque_nm;
  std::optional<std::string> name;
  std::optional<bool> needs_spindle;
  std::vector<double> frame;  ///< x y z, and the quaternion w x y z; empty: not given
};

std::string spindle_tool(const nlohmann::json& mounted) {
  if (mounted.is_null()) return "not known: look, and say it with rmac confirm NUMBER";
  return mounted == 0 ? "empty" : fmt::format("tool {}", mounted.dump());
}

std::vector<std::string> to_row(const nlohmann::json& tool) {
  const auto bound = [&](const char* key) {
    const double value = tool.at(key);
    return value > 0 ? number(value) : std::string("-");
  };
  const auto& frame = tool.at("Frame");
  const bool straight = frame.at("p") == nlohmann::json{0.0, 0.0, 0.0} && frame.at("q").at(0) == 1.0;
  return {tool.at("ToolNumber").dump(),
          tool.at("Name").get<std::string>(),
          number(tool.at("Length"), 4),
          number(tool.at("Radius"), 4),
          bound("MaxRPM"),
          bound("MaxTorque"),
          tool.at("NeedsSpindle").get<bool>() ? "yes" : "no",
          straight ? "no" : "yes"};
}

Result<> list_tools(Connection& connection, bool json) {
  const auto answer = read_tools(connection);
  if (!answer) return tl::unexpected(answer.error());
  if (json) {
    fmt::print("{}\n", answer->dump());
    return {};
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& tool : answer->at("Tools")) rows.push_back(to_row(tool));
  fmt::print("{}", table({"tool", "name", "length mm", "radius mm", "rpm at most", "N·m at most", "needs spindle",
                          "set off or turned"},
                         rows));
  fmt::print("\nspindle: {}\n", spindle_tool(answer->at("Mounted")));
  if (const auto prompt = answer->value("Prompt", ""); !prompt.empty()) fmt::print("to do: {}\n", prompt);
  return {};
}

nlohmann::json changed(nlohmann::json tool, const Wanted& wanted) {
  const auto set = [&](const char* key, const auto& value) {
    if (value) tool[key] = *value;
  };
  tool["ToolNumber"] = wanted.number;
  set("Length", wanted.length_mm);
  set("Radius", wanted.radius_mm);
  set("Name", wanted.name);
  set("MaxRPM", wanted.max_rpm);
  set("MaxTorque", wanted.max_torque_nm);
  set("NeedsSpindle", wanted.needs_spindle);
  if (!wanted.frame.empty()) {
    const auto& f = wanted.frame;
    tool["Frame"] = {{"p", {f[0], f[1], f[2]}}, {"q", {f[3], f[4], f[5], f[6]}}};
  }
  return tool;
}

/// While another client has the lease, the machine is its, and so is the table.
Result<> change_tool(Connection& connection, const Wanted& wanted) {
  const auto answer = read_tools(connection);
  if (!answer) return tl::unexpected(answer.error());
  const auto& tools = answer->at("Tools");
  const auto known =
      std::ranges::find_if(tools, [&](const auto& tool) { return tool.at("ToolNumber") == wanted.number; });
  if (known == tools.end() && !wanted.length_mm) {
    return fail(fmt::format("tool {} is new: give its --length", wanted.number));
  }
  const auto tool = changed(known == tools.end() ? nlohmann::json() : *known, wanted);
  return with_authority(connection, [&] { return set_tool(connection, tool); });
}

void add_list(Command& tools) {
  Command list = tools.add("list", "the tools; what `rmac tools` alone does");
  list.does(with_appliance(list_tools));
}

void add_set(Command& tools) {
  const auto tool = std::make_shared<Wanted>();
  Command set = tools.add("set", "add a tool, or change what is given of one that is there");
  set.option("NUMBER", &tool->number, "1 to 9999").required().within(1, 9999);
  set.option("--length", &tool->length_mm, "from where it sits to its tip, mm");
  set.option("--radius", &tool->radius_mm, "mm");
  set.option("--name", &tool->name, "for people");
  set.option("--frame", &tool->frame, "where it sits on the tool interface: x y z, mm, and the quaternion w x y z")
      .takes(7);
  set.option("--max-rpm", &tool->max_rpm, "fastest that it may turn; 0: as fast as the spindle can");
  set.option("--max-torque", &tool->max_torque_nm, "N·m; 0: not given");
  set.option("--needs-spindle", &tool->needs_spindle, "whether it cuts only while the spindle turns");
  set.does(with_appliance([tool](Connection& appliance, bool) { return change_tool(appliance, *tool); }));
}

void add_remove(Command& tools) {
  const auto number = std::make_shared<int>(1);
  Command remove = tools.add("remove", "take a tool out of the table");
  remove.option("NUMBER", number.get(), "1 to 9999").required().within(1, 9999);
  remove.does(with_appliance([number](Connection& appliance, bool) {
    return command_with_authority(appliance, "RMAC_CAM.RemoveTool", {{"ToolNumber", *number}});
  }));
}

}  // namespace

void add_tools(Command& rmac) {
  Command tools = rmac.add("tools", "the tool table of the loaded machine, and what is in its spindle");
  tools.may_have_command();
  tools.does(with_appliance(list_tools));
  for (const Registration add : {add_list, add_set, add_remove}) add(tools);
}

}  // namespace rmac::cli
