#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/mechanism/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/frame_check.hpp"
#include "rmac/motion/move_name.hpp"

namespace rmac::gateway {
namespace {

std::string described(const Tool& tool) {
  if (tool.number == kNoTool) return "no tool";
  return tool.name.empty() ? fmt::format("tool {}", tool.number) : fmt::format("tool {} ({})", tool.number, tool.name);
}

Frame tip_of(const Tool& tool) {
  return tool.number == kNoTool ? Frame{} : tip_on_interface(tool);
}

MountTool mount(const Tool& tool) {
  return {tool.number, tip_of(tool), described(tool), tool.max_torque_nm};
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
    if (now.mounted != set.number) return;
    supervisor_.set_mounted(set.number, set.max_torque_nm);
    supervisor_.set_frames({frames().part, tip_of(set)});
  });
}

Expected<> Cam::remove_tool(int number) {
  if (auto loaded = require_mechanism("RemoveTool"); !loaded) return loaded;
  if (supervisor_.tools_now().wanted) {
    return failure(MinorCode::Other, "RemoveTool: a tool change is queued; remove tools when it is done");
  }
  return rack_.remove(number);
}

BeginToolChange Cam::begin_change() const {
  const auto coolant = device_->outputs.find(kCoolantOutput);
  return {coolant == device_->outputs.end() ? 0 : std::uint64_t{1} << coolant->second};
}

std::vector<QueueStep> Cam::change_by_hand(const Tool& tool) const {
  const std::string what = tool.number == kNoTool ? "take the tool out" : fmt::format("insert {}", described(tool));
  return {begin_change(), AskPerson{fmt::format("{}, then confirm: rmac confirm {}", what, tool.number)}, mount(tool)};
}

Expected<QueueStep> Cam::changer_step(const sdk::ToolChangeStep& step, int number) {
  using Kind = sdk::ToolChangeStep::Kind;
  if (step.kind == Kind::MoveTo) {
    PathBuilder& builder = supervisor_.mechanism()->builder;
    Move move = make_joint_move(kPositioningMoveId, JointTargetGeometry{step.joints}, builder.end_joints());
    move.joint_speed_fraction = 1;
    return builder.build(move).map([](auto&& segments) {
      return QueueStep(QueuedPath{kPositioningMoveId, {}, std::move(segments)});
    });
  }
  if (step.kind == Kind::Await) {
    return AwaitInput{std::uint64_t{1} << device_->inputs.at(step.input), step.on, step.timeout_s, step.input};
  }
  if (step.kind == Kind::Select && number >= 1 << step.outputs.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("DoToolChange: tool {} has no place in the changer, which knows tools up to {}", number,
                               (1 << step.outputs.size()) - 1));
  }
  SwitchOutputs outputs;
  for (std::size_t i = 0; i < step.outputs.size(); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << device_->outputs.at(step.outputs[i]);
    outputs.mask |= bit;
    if (step.kind == Kind::Select ? ((number >> i) & 1) != 0 : step.on) outputs.values |= bit;
  }
  return outputs;
}

Expected<std::vector<QueueStep>> Cam::change_by_changer(int old, const Tool& tool) {
  using Whose = sdk::ToolChangeStep::Whose;
  std::vector<QueueStep> steps{begin_change()};
  for (const sdk::ToolChangeStep& step : device_->tool_change) {
    const int number = step.whose == Whose::Old ? old : tool.number;
    if (step.whose != Whose::Both && number == kNoTool) continue;
    auto made = changer_step(step, number);
    if (!made) return tl::unexpected(made.error());
    steps.push_back(std::move(*made));
  }
  steps.emplace_back(mount(tool));
  return steps;
}

Expected<> Cam::change_tool(int number) {
  const auto tool = find_tool(number, "DoToolChange");
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
  const Frames frames_after{frames_before.part, tip_of(*tool)};
  Expected<std::vector<QueueStep>> steps;
  if (there) {
    steps->emplace_back(mount(*tool));
  } else {
    steps =
        device_->tool_changer ? change_by_changer(now.last ? *now.last : *now.mounted, *tool) : change_by_hand(*tool);
    // Whoever ends in the midst of the change, the power included, must not be believed to have the old tool.
    if (auto noted = steps ? rack_.set_mounted(std::nullopt) : Expected<>(); !noted)
      steps = tl::unexpected(noted.error());
  }
  if (!steps) {
    builder.restart(before, frames_before);
    return tl::unexpected(steps.error());
  }
  builder.restart(joints(), frames_after);
  auto added = supervisor_.add_steps(std::move(*steps), std::move(as_sent));
  if (!added) (void)keep_mounted();
  return added;
}

Expected<> Cam::check_changer(const ToolsNow& now) const {
  if (!device_->tool_changer) return {};
  if (device_->tool_change.empty()) {
    return failure(
        MinorCode::UnsupportedOperation,
        fmt::format("DoToolChange: device.json of {} says that it has a tool changer, and not what that does; "
                    "give it the steps of ToolChange, or \"ToolChanger\": false for a change by hand",
                    device_->name));
  }
  if (now.last || now.mounted) return {};
  return failure(MinorCode::Other,
                 "DoToolChange: which tool is in the spindle is not known, because a change was not completed, and the "
                 "changer must put it back; say it with ConfirmToolChange");
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
    supervisor_.set_mounted(number, tool->max_torque_nm);
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
  const int number = now.last ? *now.last : *now.mounted;
  if (!feeds || number == kNoTool || device_->spindles.empty()) return {};
  const auto tool = rack_.tool(number);
  if (!tool || !tool->needs_spindle) return {};
  const ServoWishes wishes = supervisor_.wishes();
  const bool turns = std::ranges::any_of(wishes.spindle_rpm, [](double rpm) { return rpm != 0; });
  if (turns && !now.last) return {};
  return failure(MinorCode::Other,
                 fmt::format("move {}: {} needs the spindle turning{}; use SetSpindleRPM{} first, or give the tool "
                             "\"NeedsSpindle\": false",
                             move_id, described(*tool), now.last ? ", and its change stops it" : "",
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
  const auto tool = rack_.tool(*now.mounted);
  if (!tool || tool->max_rpm == 0 || std::abs(rpm) <= tool->max_rpm) return {};
  return failure(MinorCode::SpeedLimit, fmt::format("SetSpindleRPM: {} rpm is above the {} rpm that {} may turn", rpm,
                                                    tool->max_rpm, described(*tool)));
}

}  // namespace rmac::gateway
