#include "gateway/queue/way_back.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rmac/motion/move_name.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

/// The tool may stand this far from the place where a program goes on: what a part that is found to lie a little
/// elsewhere moves it by. A longer way back is the operator's, who sees what is in it.
constexpr double kWayBack_mm = 1;
constexpr double kWayBack_axis = 0.02;
/// Joints at the end of that way and at the begin of the path: mm or degrees.
constexpr double kSameJoints = 1e-5;
constexpr double kSlowest_mm_s = 1;

struct Place {
  ToolPose pose;
  std::vector<double> joints;
};

/// Where what was built begins: at `ahead`'s end when nothing is left of it.
Place begin_of(const PathSegments& built, const PathBuilder& ahead) {
  JointPoint point;
  if (built.empty() || built.front()->evaluate(0, 0, 1, point) != KinematicsStatus::Ok) {
    return {ahead.end_pose(), {ahead.end_joints().begin(), ahead.end_joints().end()}};
  }
  const auto count = static_cast<std::ptrdiff_t>(built.front()->joint_count());
  return {built.front()->pose(0), {point.d[0].begin(), point.d[0].begin() + count}};
}

/// A positioning move with the feed of `like`; null: as slow as it gets.
Move way_to(const Move* like, Geometry geometry) {
  Move move = like != nullptr ? *like : Move{};
  move.id = kPositioningMoveId;
  move.geometry = std::move(geometry);
  move.feed_mm_s = std::max(move.feed_mm_s, kSlowest_mm_s);
  return move;
}

tl::unexpected<Error> too_far(const ToolPose& stands, const ToolPose& place) {
  return failure(
      MinorCode::Other,
      fmt::format(
          "TakeUpProgram: the tool stands {:.3f} mm from where the program goes on, {:.4f}, {:.4f}, {:.4f} with "
          "the tool axis {:.4f}, {:.4f}, {:.4f} (part frame), and at most {} mm are made up for; move it there "
          "first",
          distance(stands.tip, place.tip), place.tip[0], place.tip[1], place.tip[2], place.axis[0], place.axis[1],
          place.axis[2], kWayBack_mm));
}

/// What is left of a step, built by `ahead`, which stands elsewhere before.
Expected<PathSegments> build_remainder(PathBuilder& ahead, const ProgramStep& first, const Move* move, bool in_joints) {
  ahead.restart(first.start_joints, ahead.frames());
  if (!in_joints) {
    // Under other frames the same joints are a little beside the step's start: from there its joints are found.
    const auto there = ahead.build(way_to(nullptr, PathTargetGeometry{first.start}));
    if (!there) return tl::unexpected(there.error());
  }
  return move != nullptr ? ahead.build(*move, first.from_mm) : PathSegments{};
}

Expected<BuiltMove> build_way(PathBuilder back, const Place& place, const Move* move, bool in_joints) {
  const ToolPose stands = back.end_pose();
  if (distance(stands.tip, place.pose.tip) > kWayBack_mm || distance(stands.axis, place.pose.axis) > kWayBack_axis) {
    return too_far(stands, place.pose);
  }
  const Move way =
      way_to(move, in_joints ? Geometry(JointTargetGeometry{place.joints}) : Geometry(PathTargetGeometry{place.pose}));
  ProgramStep as_sent = step_at(back, way);
  as_sent.way_back = true;
  auto segments = back.build(way);
  if (!segments) return tl::unexpected(segments.error());
  for (std::size_t j = 0; j < place.joints.size(); ++j) {
    if (std::abs(back.end_joints()[j] - place.joints[j]) <= kSameJoints) continue;
    return failure(MinorCode::TravelLimit,
                   fmt::format("TakeUpProgram: joint {} stands at {:.4f}, and the program goes on with the tool there "
                               "and the joint at {:.4f}; turn it there first",
                               j, back.end_joints()[j], place.joints[j]));
  }
  return BuiltMove{std::move(as_sent), {}, std::move(*segments)};
}

}  // namespace

Expected<std::vector<BuiltMove>> build_rest_of(PathBuilder& builder, const ProgramStep& first) {
  const Move* const move = std::get_if<Move>(&first.what);
  const bool in_joints = move != nullptr && is_joint_move(move->geometry);
  PathBuilder ahead = builder;
  auto rest = build_remainder(ahead, first, move, in_joints);
  if (!rest) return tl::unexpected(rest.error());
  auto way = build_way(builder, begin_of(*rest, ahead), move, in_joints);
  if (!way) return tl::unexpected(way.error());
  builder = std::move(ahead);
  std::vector<BuiltMove> moves;
  if (!way->segments.empty()) moves.push_back(std::move(*way));
  if (move != nullptr) moves.push_back({first, {}, std::move(*rest)});
  return moves;
}

}  // namespace rmac::gateway
