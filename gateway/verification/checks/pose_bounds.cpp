#include "gateway/verification/checks/pose_bounds.hpp"

#include <fmt/format.h>

#include "rmac/motion/vector.hpp"

namespace rmac::verifier {

std::optional<std::string> miss(const Kinematics& kinematics, std::span<const double> joints, const Frame& tool,
                                const ToolPose& pose, const PoseBounds& bounds) {
  if (!kinematics.has_pose(joints)) return "it gives joints that have no pose";
  ToolPose again;
  kinematics.forward(joints, tool, again);
  const double tip = distance(again.tip, pose.tip), axis = distance(again.axis, pose.axis);
  if (tip <= bounds.tip_mm && axis <= bounds.axis_rad) return std::nullopt;
  return fmt::format(
      "the forward of its joints is {} mm and {} rad off the pose asked for; {} mm and {} rad are "
      "allowed",
      tip, axis, bounds.tip_mm, bounds.axis_rad);
}

NamedNumbers named_pose(const char* name, const ToolPose& pose) {
  return {name, {pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]}};
}

NamedNumbers named_tool(const Frame& tool) {
  return {"tool", {tool.p[0], tool.p[1], tool.p[2], tool.q[0], tool.q[1], tool.q[2], tool.q[3]}};
}

}  // namespace rmac::verifier
