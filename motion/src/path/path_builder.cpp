#include "rmac/motion/path_builder.hpp"

#include "curves/make_curves.hpp"
#include "path/move_refusal.hpp"
#include "path/move_segments.hpp"
#include "path/part_of.hpp"

namespace rmac {
namespace {

/// The part of a move's segments that lies from `from_mm` on.
PathSegments rest_of(PathSegments segments, double from_mm) {
  constexpr double kNothing_mm = 1e-6;
  PathSegments rest;
  for (auto& segment : segments) {
    const double cut = from_mm - segment->stretches().front().s_begin_mm;
    if (cut >= segment->length() - kNothing_mm) continue;
    rest.push_back(cut > kNothing_mm ? part_of(*segment, cut, segment->length()) : std::move(segment));
  }
  return rest;
}

bool same(const Frames& a, const Frames& b) {
  return a.part.p == b.part.p && a.part.q == b.part.q && a.tool.p == b.tool.p && a.tool.q == b.tool.q;
}

}  // namespace

PathBuilder::PathBuilder(PlannerModel model)
    : model_(std::move(model)),
      end_joints_(model_.joints.size(), 0.0),
      map_(std::make_shared<const PoseToJoints>(Frames{}, model_.kinematics)),
      end_pose_(map_->pose(end_joints_)) {}

void PathBuilder::restart(std::span<const double> joints, const Frames& frames) {
  std::vector<double> copy(joints.begin(), joints.end());
  end_joints_ = std::move(copy);
  // Segments join only under one map: it is made anew only when the frames are others.
  if (!same(map_->frames(), frames)) map_ = std::make_shared<const PoseToJoints>(frames, model_.kinematics);
  end_pose_ = map_->pose(end_joints_);
}

Expected<PathSegments> PathBuilder::build(const Move& move, double from_mm) {
  const bool joint_move = is_joint_move(move.geometry);
  if (auto checked = check_demand(move, joint_move); !checked) return tl::unexpected(checked.error());
  if (!joint_move) {
    const Kinematics& kinematics = *model_.kinematics;
    if (!kinematics.takes(map_->frames().tool)) return tl::unexpected(not_taken(move, map_->frames().tool));
    if (!kinematics.has_pose(end_joints_)) return tl::unexpected(begins_without_pose(move, end_joints_, model_.joints));
  }
  auto curves = make_curves(move, {end_pose_, end_joints_});
  if (!curves) return tl::unexpected(curves.error());
  if (curves->empty()) return PathSegments{};

  MoveSegments laid(move, model_, map_, end_joints_);
  for (auto& curve : *curves) {
    const bool last = &curve == &curves->back();
    if (auto added = laid.lay(std::move(curve), last); !added) return tl::unexpected(added.error());
  }
  end_joints_ = laid.joints();
  const PathSegments& segments = laid.segments();
  end_pose_ = segments.back()->pose(segments.back()->length());
  return from_mm > 0 ? rest_of(segments, from_mm) : segments;
}

}  // namespace rmac
