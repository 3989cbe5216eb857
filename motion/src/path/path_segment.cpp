#include "rmac/motion/path_segment.hpp"

#include <algorithm>
#include <utility>

#include "path/joint_nodes.hpp"

namespace rmac {
PathSegment::PathSegment(std::shared_ptr<const Curve> curve, std::shared_ptr<const PoseToJoints> map,
                         const PathDemand& demand, std::vector<MoveStretch> stretches)
    : curve_(std::move(curve)),
      map_(std::move(map)),
      demand_(demand),
      stretches_(std::move(stretches)),
      length_(curve_->length()),
      joint_count_(map_->joint_count()) {
  ended_before_.reserve(stretches_.size());
  std::uint32_t ended = 0;
  for (const MoveStretch& stretch : stretches_) {
    ended_before_.push_back(ended);
    if (stretch.last_of_move) ++ended;
  }
}

const MoveStretch& PathSegment::stretch_at(double s) const noexcept {
  const auto above = std::upper_bound(stretches_.begin(), stretches_.end(), s,
                                      [](double value, const MoveStretch& stretch) { return value < stretch.begin; });
  return above == stretches_.begin() ? stretches_.front() : *(above - 1);
}

std::uint32_t PathSegment::moves_ended(double from, double to) const noexcept {
  // A stretch ends where the next one begins, the last one at the segment's end.
  const auto ended = [this](double s) {
    if (s >= length_) return ended_before_.back() + (stretches_.back().last_of_move ? 1U : 0U);
    const auto index = &stretch_at(s) - stretches_.data();
    return ended_before_[static_cast<std::size_t>(index)];
  };
  return to > from ? ended(to) - ended(from) : 0;
}

KinematicsStatus PathSegment::resolve(std::span<const double> start_joints, double& s_failed) {
  JointNodes found = joint_nodes(*curve_, *map_, start_joints);
  nodes_ = std::move(found.places);
  seeds_ = std::move(found.joints);
  s_failed = found.s_failed;
  return found.status;
}

std::span<const double> PathSegment::seed_at(double s) const noexcept {
  const auto nodes = this->nodes();
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), s);
  const auto index = above == nodes.begin() ? 0U : static_cast<std::size_t>(above - nodes.begin()) - 1;
  return joints_at_node(index);
}

KinematicsStatus PathSegment::evaluate(double s, int order, int side, JointPoint& point) const noexcept {
  CurvePoint c;
  curve_->evaluate(s, order, side, c);
  if (curve_->in_joint_space()) {
    for (std::size_t k = 0; k <= static_cast<std::size_t>(order); ++k)
      std::copy_n(c.d[k].begin(), joint_count_, point.d[k].begin());
    return KinematicsStatus::Ok;
  }
  return map_->evaluate(c, curve_->dimension(), order, seed_at(s), point);
}

KinematicsStatus PathSegment::derivatives(double s, int side, JointPoint& point) const noexcept {
  CurvePoint c;
  curve_->evaluate(s, 3, side, c);
  if (!curve_->in_joint_space()) {
    if (map_->derivatives(c, point)) return KinematicsStatus::Ok;
    return map_->evaluate(c, curve_->dimension(), 3, seed_at(s), point);
  }
  for (std::size_t k = 1; k <= 3; ++k) std::copy_n(c.d[k].begin(), joint_count_, point.d[k].begin());
  return KinematicsStatus::Ok;
}

ToolPose PathSegment::pose(double s) const noexcept {
  CurvePoint c;
  curve_->evaluate(s, 0, 1, c);
  if (curve_->in_joint_space()) return map_->pose({c.d[0].data(), joint_count_});
  return {{c.d[0][0], c.d[0][1], c.d[0][2]}, {c.d[0][3], c.d[0][4], c.d[0][5]}};
}

}  // namespace rmac
