#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/pose_to_joints.hpp"

namespace rmac {

/// What a move asks of the planner beside its geometry.
struct PathDemand {
  double feed_mm_s = 0;         ///< bound of ds/dt; for joint moves already reduced to the joints' allowed speed
  double accel_rise_mm_s2 = 0;  ///< 0: the joints alone bound it
  double accel_fall_mm_s2 = 0;
  double tolerance_mm = 0;   ///< of the corner before it
  double deviation_mm = 0;   ///< of the tolerance, what the segment itself has used: a spline through short lines
  double tolerance_rad = 0;  ///< of the tool axis, likewise
  double deviation_rad = 0;
  double joint_speed_fraction = 1;  ///< of the joints' speed limits
  bool rest_before = false;         ///< positioning moves start at rest
  bool rest_after = false;          ///< and end at rest
  bool positioning = false;         ///< of a positioning move: the tool cuts nothing
};

/// The stretch of a segment that belongs to one of the client's moves: from `begin` to the next stretch, or the end.
struct MoveStretch {
  double begin = 0;  ///< path length on the segment
  std::int64_t move_id = 0;
  double s_begin_mm = 0;     ///< path length within the move at `begin`
  double s_per_length = 1;   ///< by how much the length within the move grows along the segment
  bool last_of_move = true;  ///< the move is done at the end of the stretch
};

/// One curve of one move, or of several that were joined, seen through the kinematics: joints as a function of path
/// length. Immutable, shared between planner and servo thread; `evaluate` is const and real-time safe.
class PathSegment {
 public:
  PathSegment(std::shared_ptr<const Curve> curve, std::shared_ptr<const PoseToJoints> map, const PathDemand& demand,
              std::vector<MoveStretch> stretches);

  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }
  [[nodiscard]] const PathDemand& demand() const noexcept { return demand_; }
  [[nodiscard]] const Curve& curve() const noexcept { return *curve_; }
  [[nodiscard]] const std::shared_ptr<const Curve>& shared_curve() const noexcept { return curve_; }
  /// Shared by the segments that were made under the same frames.
  [[nodiscard]] const std::shared_ptr<const PoseToJoints>& map() const noexcept { return map_; }
  [[nodiscard]] std::span<const MoveStretch> stretches() const noexcept { return stretches_; }
  /// The stretch that holds s; at a border the one that begins there. Real-time safe.
  [[nodiscard]] const MoveStretch& stretch_at(double s) const noexcept;
  /// Moves of which the end lies in (from, to]. Real-time safe.
  [[nodiscard]] std::uint32_t moves_ended(double from, double to) const noexcept;

  /// Finds the joints along the whole segment, node by node from `start_joints`, so that `evaluate` has seeds. Called
  /// once before use; the status of the first place that has no solution, and its path length, otherwise.
  [[nodiscard]] KinematicsStatus resolve(std::span<const double> start_joints, double& s_failed);

  /// Joints and their derivatives up to `order` (0 to 3) at s in [0, length()]; `side` as in `Curve::evaluate`.
  [[nodiscard]] KinematicsStatus evaluate(double s, int order, int side, JointPoint& point) const noexcept;

  /// As `evaluate` to the third order, without the joints themselves, d[0], where the derivatives can be had without.
  [[nodiscard]] KinematicsStatus derivatives(double s, int side, JointPoint& point) const noexcept;

  /// Path lengths at which `resolve` found the joints: the curve's nodes, and others where the joints bend more than
  /// the curve does. Ascending, the ends among them.
  [[nodiscard]] std::span<const double> nodes() const noexcept {
    return nodes_.empty() ? curve_->nodes() : std::span<const double>(nodes_);
  }
  /// The joints at one of them.
  [[nodiscard]] std::span<const double> joints_at_node(std::size_t node) const noexcept {
    return {seeds_.data() + node * joint_count_, joint_count_};
  }
  /// A joint moves by at most this much a mm of the segment; infinite where no bound is known.
  [[nodiscard]] double largest_rate(std::size_t joint) const noexcept {
    return curve_->in_joint_space() ? 1 : map_->largest_rate(joint);
  }

  /// Tool pose in the part frame at s (through the forward kinematics for joint moves).
  [[nodiscard]] ToolPose pose(double s) const noexcept;

 private:
  [[nodiscard]] std::span<const double> seed_at(double s) const noexcept;

  std::shared_ptr<const Curve> curve_;
  std::shared_ptr<const PoseToJoints> map_;
  PathDemand demand_;
  std::vector<MoveStretch> stretches_;
  std::vector<std::uint32_t> ended_before_;  ///< moves that end before each stretch begins
  double length_ = 0;
  std::size_t joint_count_ = 0;
  std::vector<double> nodes_;  ///< empty: the curve's
  std::vector<double> seeds_;  ///< joint_count_ values a node
};

/// Segments in the order in which they are travelled.
using PathSegments = std::vector<std::shared_ptr<const PathSegment>>;

}  // namespace rmac
