#include "gateway/rmac_cam/cam_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {

void CamTools::mechanism_changed(bool fresh) {
  if (!fresh) return;
  // The tool stays in the spindle whoever was loaded meanwhile.
  const auto mounted = device_.get() != nullptr ? rack_.mounted() : kNoTool;
  const auto tool = mounted && *mounted != kNoTool ? rack_.tool(*mounted) : std::nullopt;
  supervisor_.set_mounted(mounted, tool ? tool->max_torque_nm : 0);
  const auto in_spindle = mounted == kNoTool ? std::optional(Tool{.number = kNoTool}) : tool;
  supervisor_.guarding().set_tool(in_spindle ? std::make_shared<const Tool>(*in_spindle) : nullptr);
  if (tool) supervisor_.set_frames({{}, tip_on_interface(*tool)});
}

Expected<Tool> CamTools::find(int number, const char* function) const {
  if (auto loaded = device_.require(function); !loaded) return tl::unexpected(loaded.error());
  if (number == kNoTool) return Tool{.number = kNoTool, .needs_spindle = false};
  return rack_.find(number, function);
}

void CamTools::put_in_spindle(const Tool& tool) {
  supervisor_.set_mounted(tool.number, tool.max_torque_nm);
  supervisor_.guarding().set_tool(std::make_shared<const Tool>(tool));
  supervisor_.set_frames({supervisor_.wishes().frames.part, tip_on_interface(tool)});
}

Expected<std::vector<Tool>> CamTools::tools() const {
  return device_.require("GetTools").map([&] {
    std::vector<Tool> all;
    for (const auto& [number, tool] : rack_.tools()) all.push_back(tool);
    return all;
  });
}

Expected<> CamTools::set_tool(const Tool& tool) {
  if (auto loaded = device_.require("SetTool"); !loaded) return loaded;
  if (auto fine = check_frame(tool.frame, "SetTool: Frame"); !fine) return fine;
  const ToolsNow now = supervisor_.tools_now();
  const bool in_use = now.mounted == tool.number || now.wanted;
  if (auto rest = in_use ? supervisor_.require_rest("SetTool of a tool in use") : Expected<>(); !rest) return rest;
  Tool set = tool;
  set.frame = normalized(tool.frame);
  return rack_.set(set).map([&] {
    // With the shape that the table has kept.
    if (now.mounted == set.number) put_in_spindle(rack_.tool(set.number).value_or(set));
  });
}

Expected<> CamTools::remove_tool(int number) {
  if (auto loaded = device_.require("RemoveTool"); !loaded) return loaded;
  if (supervisor_.tools_now().wanted) {
    return failure(MinorCode::Other, "RemoveTool: a tool change is queued; remove tools when it is done");
  }
  return rack_.remove(number);
}

Expected<> CamTools::change_tool(int number) {
  const auto tool = find(number, "DoToolChange");
  if (!tool) return tl::unexpected(tool.error());
  if (auto ready = supervisor_.prepare_move(); !ready) return ready;
  const ToolsNow now = supervisor_.tools_now();
  const bool there = now.last ? now.last == number : now.mounted == number;
  if (auto able = check_changer(now); !able && !there) return able;
  PathBuilder& builder = supervisor_.mechanism()->builder;
  const auto joints = [&] { return std::vector<double>(builder.end_joints().begin(), builder.end_joints().end()); };
  const std::vector<double> before = joints();
  const Frames frames_before = builder.frames();
  ProgramStep as_sent = step_at(builder, number);
  auto steps = there ? Expected<std::vector<QueueStep>>(std::vector<QueueStep>{ToolChangeSteps::mount(*tool)})
                     : make_change(now, *tool);
  if (!steps) {
    builder.restart(before, frames_before);
    return tl::unexpected(steps.error());
  }
  builder.restart(joints(), {frames_before.part, tip_on_interface(*tool)});
  auto added = supervisor_.add_steps("DoToolChange", std::move(*steps), std::move(as_sent));
  if (!added) (void)keep_mounted();
  return added;
}

Expected<std::vector<QueueStep>> CamTools::make_change(const ToolsNow& now, const Tool& tool) {
  Expected<std::vector<QueueStep>> steps;
  if (device_.get()->tool_changer) {
    steps = steps_.by_changer(now.last ? *now.last : *now.mounted, tool, supervisor_.mechanism()->builder);
  } else {
    steps = steps_.by_hand(tool);
  }
  if (!steps) return steps;
  // Whoever ends in the midst of the change, the power included, must not be believed to have the old tool.
  if (auto noted = rack_.set_mounted(std::nullopt); !noted) return tl::unexpected(noted.error());
  return steps;
}

Expected<> CamTools::check_changer(const ToolsNow& now) const {
  const sdk::DeviceObject& device = *device_.get();
  if (!device.tool_changer) return {};
  if (device.tool_change.empty()) {
    return failure(
        MinorCode::UnsupportedOperation,
        fmt::format("DoToolChange: device.json of {} says that it has a tool changer, and not what that does; "
                    "give it the steps of ToolChange, or \"ToolChanger\": false for a change by hand",
                    device.name));
  }
  if (now.last || now.mounted) return {};
  return failure(MinorCode::Other,
                 "DoToolChange: which tool is in the spindle is not known, because a change was not completed, and the "
                 "changer must put it back; say it with ConfirmToolChange");
}

Expected<> CamTools::confirm_tool(int number) {
  const auto tool = find(number, "ConfirmToolChange");
  if (!tool) return tl::unexpected(tool.error());
  const ToolsNow now = supervisor_.tools_now();
  if (now.wanted) return supervisor_.confirm_tool(number);
  if (now.mounted == number) return {};
  if (now.mounted) {
    return failure(
        MinorCode::Other,
        fmt::format("ConfirmToolChange: tool {} is in the spindle and no change is under way; change it with "
                    "DoToolChange",
                    *now.mounted));
  }
  return supervisor_.require_rest("ConfirmToolChange").and_then([&] { return rack_.set_mounted(number); }).map([&] {
    put_in_spindle(*tool);
  });
}

Expected<> CamTools::keep_mounted() {
  if (device_.get() == nullptr) return {};
  const ToolsNow now = supervisor_.tools_now();
  return rack_.set_mounted(now.wanted ? std::nullopt : now.mounted);
}

Expected<> CamTools::check_move(std::int64_t move_id, bool feeds) const {
  const ToolsNow now = supervisor_.tools_now();
  if (!now.last && !now.mounted) {
    return failure(
        MinorCode::Other,
        fmt::format("move {}: which tool is in the spindle is not known, because a change was not completed; "
                    "say it with ConfirmToolChange",
                    move_id));
  }
  const int number = now.last ? *now.last : *now.mounted;
  if (!feeds || number == kNoTool || device_.get()->spindles.empty()) return {};
  const auto tool = rack_.tool(number);
  if (!tool || !tool->needs_spindle) return {};
  if (std::ranges::any_of(now.spindle_rpm, [](double rpm) { return rpm != 0; })) return {};
  return failure(MinorCode::Other,
                 fmt::format("move {}: {} needs the spindle turning{}; use SetSpindleRPM{} first, or queue it in the "
                             "program with InTurn, or give the tool \"NeedsSpindle\": false",
                             move_id, described(*tool), now.last ? ", and its change stops it" : "",
                             now.last ? " when the change is done" : ""));
}

Expected<> CamTools::check_speed(double rpm) const {
  if (rpm == 0) return {};
  const ToolsNow now = supervisor_.tools_now();
  if (now.changing) return failure(MinorCode::Other, "SetSpindleRPM: a tool change is under way; wait for its end");
  if (!now.mounted) {
    return failure(MinorCode::Other,
                   "SetSpindleRPM: which tool is in the spindle is not known, because a change was not completed; say "
                   "it with ConfirmToolChange");
  }
  return check_bears("SetSpindleRPM", *now.mounted, rpm);
}

Expected<> CamTools::check_speed_in_turn(double rpm) const {
  const ToolsNow now = supervisor_.tools_now();
  const auto number = now.last ? now.last : now.mounted;
  if (rpm == 0) return {};
  if (number) return check_bears("InTurn", *number, rpm);
  return failure(MinorCode::Other,
                 "InTurn: which tool is in the spindle is not known, because a change was not completed; say it with "
                 "ConfirmToolChange");
}

Expected<> CamTools::check_bears(const char* function, int number, double rpm) const {
  const auto tool = rack_.tool(number);
  if (!tool || tool->max_rpm == 0 || std::abs(rpm) <= tool->max_rpm) return {};
  return failure(MinorCode::SpeedLimit, fmt::format("{}: {} rpm is above the {} rpm that {} may turn", function, rpm,
                                                    tool->max_rpm, described(*tool)));
}

}  // namespace rmac::gateway
