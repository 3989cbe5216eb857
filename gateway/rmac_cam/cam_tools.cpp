#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/controller/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

std::string described(const Tool& tool) {
  if (tool.number == kNoTool) return "no tool";
  return tool.name.empty() ? fmt::format("tool {}", tool.number) : fmt::format("tool {} ({})", tool.number, tool.name);
}

Frame tip_of(const Tool& tool) {
  return tool.number == kNoTool ? Frame{} : tip_on_interface(tool);
}

}  // namespace

Expected<Tool> Cam::find_tool(int number, const char* function) const {
  if (auto loaded = require_mechanism(function); !loaded) return tl::unexpected(loaded.error());
  if (number == kNoTool) return Tool{.number = kNoTool, .needs_spindle = false};
  return rack_.find(number, function);
}

Expected<std::vector<Tool>> Cam::tools() const {
  return require_mechanism("GetTools").map([&] {
    std::vector<Tool> all;
    for (const auto& [number, tool] : rack_.tools()) all.push_back(tool);
    return all;
  });
}

Expected<> Cam::set_tool(const Tool& tool) {
  if (auto loaded = require_mechanism("SetTool"); !loaded) return loaded;
  if (auto fine = check_frame(tool.frame, "SetTool: Frame"); !fine) return fine;
  const ToolsNow now = supervisor_.tools_now();
  const bool in_use = now.mounted == tool.number || now.wanted;
  if (auto rest = in_use ? supervisor_.require_rest("SetTool of a tool in use") : Expected<>(); !rest) return rest;
  Tool set = tool;
  set.frame = normalized(tool.frame);
  return rack_.set(set).map([&] {
    if (now.mounted == set.number) supervisor_.set_frames({frames().part, tip_of(set)});
  });
}

Expected<> Cam::remove_tool(int number) {
  if (auto loaded = require_mechanism("RemoveTool"); !loaded) return loaded;
  if (supervisor_.tools_now().wanted) {
    return failure(MinorCode::Other, "RemoveTool: a tool change is queued; remove tools when it is done");
  }
  return rack_.remove(number);
}

std::vector<QueueStep> Cam::change_by_hand(const Tool& tool) const {
  const auto coolant = device_->outputs.find(kCoolantOutput);
  const std::uint64_t off = coolant == device_->outputs.end() ? 0 : std::uint64_t{1} << coolant->second;
  const std::string what = tool.number == kNoTool ? "take the tool out" : fmt::format("insert {}", described(tool));
  return {BeginToolChange{off}, AskPerson{fmt::format("{}, then confirm: rmac confirm {}", what, tool.number)},
          MountTool{tool.number, tip_of(tool), described(tool)}};
}

Expected<> Cam::change_tool(int number) {
  const auto tool = find_tool(number, "DoToolChange");
  if (!tool) return tl::unexpected(tool.error());
  if (auto ready = supervisor_.prepare_move(); !ready) return ready;
  const ToolsNow now = supervisor_.tools_now();
  const bool there = now.last ? now.last == number : now.mounted == number;
  std::vector<QueueStep> steps;
  if (there) {
    steps.emplace_back(MountTool{number, tip_of(*tool), described(*tool)});
  } else {
    steps = change_by_hand(*tool);
    // Whoever ends in the midst of the change, the power included, must not be believed to have the old tool.
    if (auto noted = rack_.set_mounted(std::nullopt); !noted) return noted;
  }
  PathBuilder& builder = supervisor_.mechanism()->builder;
  const std::vector<double> joints(builder.end_joints().begin(), builder.end_joints().end());
  builder.restart(joints, {builder.frames().part, tip_of(*tool)});
  auto added = supervisor_.add_steps(std::move(steps));
  if (!added) (void)keep_mounted();
  return added;
}

Expected<> Cam::confirm_tool(int number) {
  const auto tool = find_tool(number, "ConfirmToolChange");
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
    supervisor_.set_mounted(number);
    supervisor_.set_frames({frames().part, tip_of(*tool)});
  });
}

Expected<> Cam::keep_mounted() {
  if (device_ == nullptr) return {};
  const ToolsNow now = supervisor_.tools_now();
  return rack_.set_mounted(now.wanted ? std::nullopt : now.mounted);
}

Expected<> Cam::check_tool(std::int64_t move_id, bool feeds) const {
  const ToolsNow now = supervisor_.tools_now();
  if (!now.last && !now.mounted) {
    return failure(
        MinorCode::Other,
        fmt::format("move {}: which tool is in the spindle is not known, because a change was not completed; "
                    "say it with ConfirmToolChange",
                    move_id));
  }
  const auto tool = rack_.tools().find(now.last ? *now.last : *now.mounted);
  if (!feeds || tool == rack_.tools().end() || !tool->second.needs_spindle || device_->spindles.empty()) return {};
  const ServoWishes wishes = supervisor_.wishes();
  const bool turns = std::ranges::any_of(wishes.spindle_rpm, [](double rpm) { return rpm != 0; });
  if (turns && !now.last) return {};
  return failure(MinorCode::Other,
                 fmt::format("move {}: {} needs the spindle turning{}; use SetSpindleRPM{} first, or give the tool "
                             "\"NeedsSpindle\": false",
                             move_id, described(tool->second), now.last ? ", and its change stops it" : "",
                             now.last ? " when the change is done" : ""));
}

Expected<> Cam::check_tool_speed(double rpm) const {
  if (rpm == 0) return {};
  const ToolsNow now = supervisor_.tools_now();
  if (now.changing) return failure(MinorCode::Other, "SetSpindleRPM: a tool change is under way; wait for its end");
  if (!now.mounted) {
    return failure(MinorCode::Other,
                   "SetSpindleRPM: which tool is in the spindle is not known, because a change was not completed; say "
                   "it with ConfirmToolChange");
  }
  const auto tool = rack_.tools().find(*now.mounted);
  if (tool == rack_.tools().end() || tool->second.max_rpm == 0 || std::abs(rpm) <= tool->second.max_rpm) return {};
  return failure(MinorCode::SpeedLimit, fmt::format("SetSpindleRPM: {} rpm is above the {} rpm that {} may turn", rpm,
                                                    tool->second.max_rpm, described(tool->second)));
}

}  // namespace rmac::gateway
