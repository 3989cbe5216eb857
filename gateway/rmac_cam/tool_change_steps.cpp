#include "gateway/rmac_cam/tool_change_steps.hpp"

#include <fmt/format.h>

#include <memory>

#include "rmac/motion/move_name.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac::gateway {

std::string described(const Tool& tool) {
  if (tool.number == kNoTool) return "no tool";
  return tool.name.empty() ? fmt::format("tool {}", tool.number) : fmt::format("tool {} ({})", tool.number, tool.name);
}

MountTool ToolChangeSteps::mount(const Tool& tool) {
  return {tool.number, tip_on_interface(tool), described(tool), tool.max_torque_nm, std::make_shared<const Tool>(tool)};
}

std::vector<QueueStep> ToolChangeSteps::by_hand(const Tool& tool) const {
  const std::string what = tool.number == kNoTool ? "take the tool out" : fmt::format("insert {}", described(tool));
  return {BeginToolChange{device_.coolant()},
          AskPerson{fmt::format("{}, then confirm: rmac confirm {}", what, tool.number)}, mount(tool)};
}

Expected<QueueStep> ToolChangeSteps::make_step(const sdk::ToolChangeStep& step, int number,
                                               PathBuilder& builder) const {
  using Kind = sdk::ToolChangeStep::Kind;
  const sdk::DeviceObject& device = *device_.get();
  if (step.kind == Kind::MoveTo) {
    Move move = maker_.joint_move(kPositioningMoveId, JointTargetGeometry{step.joints}, builder.end_joints());
    move.joint_speed_fraction = 1;
    return builder.build(move).map([](PathSegments segments) {
      return QueueStep(QueuedPath{kPositioningMoveId, {}, std::move(segments)});
    });
  }
  if (step.kind == Kind::Await) {
    return AwaitInput{std::uint64_t{1} << device.inputs.at(step.input), step.on, step.timeout_s, step.input};
  }
  if (step.kind == Kind::Select && number >= 1 << step.outputs.size()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("DoToolChange: tool {} has no place in the changer, which knows tools up to {}", number,
                               (1 << step.outputs.size()) - 1));
  }
  SwitchOutputs outputs;
  for (std::size_t i = 0; i < step.outputs.size(); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << device.outputs.at(step.outputs[i]);
    outputs.mask |= bit;
    if (step.kind == Kind::Select ? ((number >> i) & 1) != 0 : step.on) outputs.values |= bit;
  }
  return outputs;
}

Expected<std::vector<QueueStep>> ToolChangeSteps::by_changer(int old, const Tool& tool, PathBuilder& builder) const {
  using Whose = sdk::ToolChangeStep::Whose;
  std::vector<QueueStep> steps{BeginToolChange{device_.coolant()}};
  for (const sdk::ToolChangeStep& wanted : device_.get()->tool_change) {
    const int number = wanted.whose == Whose::Old ? old : tool.number;
    if (wanted.whose != Whose::Both && number == kNoTool) continue;
    auto made = make_step(wanted, number, builder);
    if (!made) return tl::unexpected(made.error());
    steps.push_back(std::move(*made));
  }
  steps.emplace_back(mount(tool));
  return steps;
}

}  // namespace rmac::gateway
