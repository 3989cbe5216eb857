#include "gateway/rmac_cam/cam_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

/// More than any machine tool's geometry has; a module that has more is asked for the nearest.
constexpr std::size_t kMostSolutions = 16;

/// The one of several solutions that lies within all travels and has the shortest way for the joint that takes longest;
/// none where every solution leaves the travel.
std::optional<std::vector<double>> nearest_within_travel(std::span<double> solutions, std::span<const double> from,
                                                         const std::vector<JointLimits>& joints) {
  std::optional<std::vector<double>> nearest;
  double shortest = 0;
  for (std::size_t first = 0; first < solutions.size(); first += joints.size()) {
    const std::span<double> solution = solutions.subspan(first, joints.size());
    bool reached = true;
    double longest = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      solution[j] = unwound(joints[j], solution[j]);
      reached = reached && within_travel(joints[j], solution[j]);
      longest = std::max(longest, std::abs(solution[j] - from[j]) / joints[j].max_speed);
    }
    if (!reached || (nearest && longest >= shortest)) continue;
    shortest = longest;
    nearest.emplace(solution.begin(), solution.end());
  }
  return nearest;
}

}  // namespace

Expected<> CamQueue::add(std::int64_t id, const Geometry& geometry) {
  if (auto loaded = device_.require("move"); !loaded) return loaded;
  const bool in_joints = is_joint_move(geometry);
  if (auto fed = in_joints ? Expected<>() : path_.check_feed(id); !fed) return fed;
  if (auto fits = tools_.check_move(id, !in_joints && !std::holds_alternative<PathTargetGeometry>(geometry)); !fits) {
    return fits;
  }
  return supervisor_.prepare_move()
      .and_then([&] {
        const auto* target = std::get_if<JointTargetGeometry>(&geometry);
        if (target == nullptr) return supervisor_.add_move(maker_.path_move(id, geometry));
        return supervisor_.add_move(maker_.joint_move(id, *target, supervisor_.mechanism()->builder.end_joints()));
      })
      .map([](bool) {});
}

Expected<std::vector<double>> CamQueue::joints_at(const ToolPose& pose) const {
  if (auto loaded = device_.require("MoveToJointTarget"); !loaded) return tl::unexpected(loaded.error());
  // Where the queue ends is known only once the builder stands where the next move begins.
  if (auto ready = supervisor_.prepare_move(); !ready) return tl::unexpected(ready.error());
  const std::shared_ptr<Mechanism> mechanism = supervisor_.mechanism();
  const PathBuilder& builder = mechanism->builder;
  const Kinematics& kinematics = *mechanism->planner_model.kinematics;
  std::vector<double> all(kMostSolutions * kinematics.joint_count());
  const std::size_t count = kinematics.solutions(apply_to_pose(builder.frames().part, pose), builder.frames().tool,
                                                 builder.end_joints(), all);
  if (count == 0) {
    return failure(MinorCode::TravelLimit,
                   fmt::format("MoveToJointTarget: no joint positions give the pose with the tip at {}, {}, {} mm and "
                               "the axis {}, {}, {}",
                               pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]));
  }
  const std::vector<double> nearest(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kinematics.joint_count()));
  all.resize(count * kinematics.joint_count());
  // Where none is inside, the move says which joint leaves its travel, and by how much.
  return nearest_within_travel(all, builder.end_joints(), mechanism->planner_model.joints).value_or(nearest);
}

}  // namespace rmac::gateway
