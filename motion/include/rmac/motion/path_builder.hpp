#pragma once

#include <memory>
#include <span>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/planner_model.hpp"

namespace rmac {

/// Turns moves into checked path segments. Knows where the queue ends. Gateway thread.
class PathBuilder {
 public:
  explicit PathBuilder(PlannerModel model);

  /// Forgets the queue: the next move starts from these joints. Frames may change only when the machine is at rest and
  /// the queue empty.
  void restart(std::span<const double> joints, const Frames& frames);

  /// Segments of one move (none for a positioning move to where the queue ends already), checked for geometry, reach,
  /// singularity and joint travel before anything moves. An error names the joint, the amount and the path length of
  /// the first offence; then the queue's end is unchanged.
  /// With `from_mm` only what lies from there on along the move, which was begun before.
  [[nodiscard]] Expected<PathSegments> build(const Move& move, double from_mm = 0);

  /// Tool pose (part frame; no numbers where the joints have none) and joints at the end of what was built.
  [[nodiscard]] const ToolPose& end_pose() const noexcept { return end_pose_; }
  [[nodiscard]] std::span<const double> end_joints() const noexcept { return end_joints_; }
  [[nodiscard]] const Frames& frames() const noexcept { return map_->frames(); }

 private:
  PlannerModel model_;
  std::vector<double> end_joints_;
  std::shared_ptr<const PoseToJoints> map_;
  ToolPose end_pose_;
};

}  // namespace rmac
