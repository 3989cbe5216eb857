#include <fmt/format.h>

#include "gateway/controller/mechanism.hpp"
#include "gateway/rmac_cam/cam.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {

Expected<std::vector<double>> Cam::joints_at(const ToolPose& pose) const {
  if (auto loaded = require_mechanism("MoveToJointTarget"); !loaded) return tl::unexpected(loaded.error());
  // Where the queue ends is known only once the builder stands where the next move begins.
  if (auto ready = supervisor_.prepare_move(); !ready) return tl::unexpected(ready.error());
  const std::shared_ptr<Mechanism> mechanism = supervisor_.mechanism();
  const PathBuilder& builder = mechanism->builder;
  const Kinematics& kinematics = *mechanism->planner_model.kinematics;
  std::vector<double> joints(kinematics.joint_count());
  const KinematicsStatus status = kinematics.inverse(apply_to_pose(builder.frames().part, pose), builder.frames().tool,
                                                     builder.end_joints(), joints);
  if (status == KinematicsStatus::Ok) return joints;
  return failure(MinorCode::TravelLimit,
                 fmt::format("MoveToJointTarget: {} the pose with the tip at {}, {}, {} mm",
                             status == KinematicsStatus::OutOfReach ? "no joint positions give"
                                                                    : "the joints are not determined at",
                             pose.tip[0], pose.tip[1], pose.tip[2]));
}

}  // namespace rmac::gateway
