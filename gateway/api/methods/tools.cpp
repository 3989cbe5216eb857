// RMAC_CAM.*: the tool table, and changing tools.
#include <fmt/format.h>

#include "gateway/api/method_builder.hpp"
#include "gateway/api/methods/method_table.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

constexpr Range kToolNumbers{1, kLargestToolNumber};

json entry_of(const Tool& tool) {
  return {{"ToolNumber", tool.number},          {"Name", tool.name},
          {"Length", tool.length_mm},           {"Radius", tool.radius_mm},
          {"Frame", frame_to_json(tool.frame)}, {"MaxRPM", tool.max_rpm},
          {"MaxTorque", tool.max_torque_nm},    {"NeedsSpindle", tool.needs_spindle}};
}

json or_null(const std::optional<int>& number) {
  return number ? json(*number) : json();
}

tl::expected<json, RpcError> list(Call& call) {
  const auto tools = call.machine.tools().tools();
  if (!tools) return tl::unexpected<RpcError>(to_rpc_error(tools.error()));
  const ToolsNow now = call.machine.tools().tools_now();
  json entries = json::array();
  for (const Tool& tool : *tools) entries.push_back(entry_of(tool));
  return json{{"Mounted", or_null(now.mounted)},
              {"Wanted", or_null(now.wanted)},
              {"Prompt", now.prompt},
              {"Tools", std::move(entries)}};
}

}  // namespace

void add_tool_methods(std::vector<Method>& table) {
  const auto add = [&](Method entry) { table.push_back(std::move(entry)); };
  add(method("RMAC_CAM.DoToolChange",
             "Changes the tool when the moves queued before it are done; moves queued after it are with the new tool. "
             "Without a changer the machine stops, spindle and coolant too, and waits for a person.")
          .takes(integer("ToolNumber").within(0, kLargestToolNumber).noted("0: an empty spindle"))
          .gives(WireType::Boolean)
          .causes(Effect::Queues)
          .does([](Call& call, std::int64_t number) {
            return call.machine.tools().change_tool(static_cast<int>(number));
          }));
  add(method("RMAC_CAM.ConfirmToolChange",
             "A person at the machine says that this tool is in the spindle: the one that was asked for, and the moves "
             "behind the change go on; or, when that is not known because a change was not completed, the one that is "
             "there. Whoever is connected may say it: it starts nothing that the holder of authority did not queue.")
          .takes(integer("ToolNumber").within(0, kLargestToolNumber).noted("0: an empty spindle"))
          .gives(WireType::Boolean)
          .causes(Effect::Starts)
          .needs(Permission::Anyone)
          .extension()
          .does([](Call& call, std::int64_t number) {
            auto confirmed = call.machine.tools().confirm_tool(static_cast<int>(number));
            if (confirmed && !call.session.has_authority()) {
              call.session.tell(fmt::format("says that tool {} is in the spindle", number));
            }
            return confirmed;
          }));
  add(method("RMAC_CAM.GetTools",
             "The mechanism's tool table; the number of the tool in the spindle (0: none, null: not known) and of the "
             "one that the next queued change wants (null: none); and what a person was asked to do.")
          .gives(WireType::Object)
          .extension()
          .does(list));
  add(method("RMAC_CAM.SetTool",
             "Adds a tool to the mechanism's table, or replaces the one of its number; of the tool in the spindle at "
             "rest, and in force at once.")
          .takes(
              integer("ToolNumber").within(kToolNumbers), number("Length", "mm").within(0, 10000),
              number("Radius", "mm").within(0, 1000).optional(), text("Name").optional(),
              frame("Frame")
                  .within(-10000, 10000)
                  .optional()
                  .noted("where it sits on the tool interface before its length: an angle head's turn; unturned unless "
                         "given"),
              number("MaxRPM", "rpm").within(0, 1e6).optional().noted("0: as fast as the spindle can"),
              number("MaxTorque", "N·m").within(0, 1e6).optional().noted("0: not given; nobody watches it"),
              boolean("NeedsSpindle")
                  .optional()
                  .noted("feed moves are refused while the spindle stands; true unless given"))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t number, double length, std::optional<double> radius,
                   std::optional<std::string> name, std::optional<Frame> frame, std::optional<double> max_rpm,
                   std::optional<double> max_torque, std::optional<bool> needs_spindle) {
            return call.machine.tools().set_tool({.number = static_cast<int>(number),
                                                  .name = name.value_or(""),
                                                  .length_mm = length,
                                                  .radius_mm = radius.value_or(0),
                                                  .frame = frame.value_or(Frame{}),
                                                  .max_rpm = max_rpm.value_or(0),
                                                  .max_torque_nm = max_torque.value_or(0),
                                                  .needs_spindle = needs_spindle.value_or(true)});
          }));
  add(method("RMAC_CAM.RemoveTool", "Takes a tool out of the mechanism's table; not the one in the spindle.")
          .takes(integer("ToolNumber").within(kToolNumbers))
          .needs(Permission::Authority)
          .extension()
          .does([](Call& call, std::int64_t number) {
            return call.machine.tools().remove_tool(static_cast<int>(number));
          }));
}

}  // namespace rmac::gateway
