#include "gateway/rmac_cam/settings/tool_place.hpp"

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {

ToolPose ToolPlace::in_machine() const {
  // Not from a sample: frames set just now are not in it yet.
  const ServoStatus now = link_.status.read();
  const Frames frames = supervisor_.wishes().frames;
  return pose_of(*supervisor_.mechanism()->planner_model.kinematics, {now.position_set.data(), now.joint_count},
                 frames.tool);
}

ToolPose ToolPlace::in_part() const {
  return apply_to_pose(inverse(supervisor_.wishes().frames.part), in_machine());
}

ToolPose ToolPlace::at(std::span<const double> joints) const {
  const Frames frames = supervisor_.wishes().frames;
  return apply_to_pose(inverse(frames.part),
                       pose_of(*supervisor_.mechanism()->planner_model.kinematics, joints, frames.tool));
}

}  // namespace rmac::gateway
