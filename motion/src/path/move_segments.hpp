#pragma once

#include <memory>
#include <span>
#include <vector>

#include "path/pole_passage.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/planner_model.hpp"

namespace rmac {

/// The segments of one move, laid curve by curve behind each other. One smooth curve in, one segment out; a curve is
/// cut where the joints' acceleration would have to jump, and led past the pole where its tool axis comes near it. Each
/// segment is checked for reach and joint travel as it is laid. What it refers to must outlive it.
class MoveSegments {
 public:
  MoveSegments(const Move& move, const PlannerModel& model, std::shared_ptr<const PoseToJoints> map,
               std::span<const double> start_joints);

  /// Lays the move's next curve. After a refusal nothing of the move is to be used.
  [[nodiscard]] Expected<> lay(const std::shared_ptr<const Curve>& curve, bool last);

  [[nodiscard]] const PathSegments& segments() const noexcept { return segments_; }
  /// The joints at the end of what is laid.
  [[nodiscard]] const std::vector<double>& joints() const noexcept { return joints_; }

 private:
  using CurvePtr = std::shared_ptr<const Curve>;

  [[nodiscard]] double joint_feed(const Curve& curve) const;
  [[nodiscard]] Expected<> lay_past_poles(const CurvePtr& curve, const PoleMap& poles, bool last);
  [[nodiscard]] Expected<> pass_pole(const CurvePtr& near, const PathSegment* before, const CurvePtr& next, bool last);
  [[nodiscard]] Expected<> lay_cut(const CurvePtr& curve, bool last);
  [[nodiscard]] Expected<std::vector<double>> cuts_of(const CurvePtr& curve) const;
  [[nodiscard]] Expected<> append(const CurvePtr& piece, bool last);

  const Move& move_;
  const PlannerModel& model_;
  std::shared_ptr<const PoseToJoints> map_;
  bool joint_move_;
  bool positioning_;
  PathDemand demand_;
  MoveStretch stretch_;  ///< of the segment that is laid next
  std::vector<double> joints_;
  std::vector<double> excess_;  ///< of each joint over its travel, where the segments end
  PathSegments segments_;
};

}  // namespace rmac
