#include "build.hpp"
#include "vector.hpp"

namespace rmac {
namespace curves {
namespace {

/// A pose with its axis brought to length 1, if it is finite and the axis nearly unit.
Expected<ToolPose> checked(const ToolPose& pose, const char* which) {
  if (!finite(pose.tip) || !finite(pose.axis)) {
    return refuse(std::string("the ") + which + " holds a number that is not finite");
  }
  const double length = norm(pose.axis);
  if (!(std::abs(length - 1) <= 1e-6)) {
    return refuse(std::string("the tool axis of the ") + which + " has length " + text(length) +
                  "; it must be 1 (to 1e-6)");
  }
  return ToolPose{pose.tip, scaled(1 / length, pose.axis)};
}

Expected<> check_start_pose(const ToolPose& pose, const CurveStart& start) {
  if (auto joined = curves::check_start(pose.tip, start); !joined) return joined;
  return check_start_axis(pose.axis, start);
}

Expected<CurveList> listed(Expected<CurvePtr> curve) {
  if (!curve) return tl::unexpected(curve.error());
  if (*curve == nullptr) return CurveList{};
  CurveList list;
  list.push_back(std::move(*curve));
  return list;
}

/// Line, arcs: start and end checked, then built from where the queue ends.
template <typename Shape, typename Build>
Expected<CurveList> joined(Shape shape, const CurveStart& start, const Build& build) {
  const auto begin = checked(shape.start, "start");
  if (!begin) return tl::unexpected(begin.error());
  const auto end = checked(shape.end, "end");
  if (!end) return tl::unexpected(end.error());
  if (auto fits = check_start_pose(*begin, start); !fits) return tl::unexpected(fits.error());
  shape.end = *end;
  return listed(build(shape, start.pose));
}

Expected<CurveList> curves_of(const LineGeometry& line, const CurveStart& start) {
  return joined(line, start,
                [](const LineGeometry& shape, const ToolPose& begin) { return make_line(begin, shape.end); });
}

Expected<CurveList> curves_of(const ArcGeometry& arc, const CurveStart& start) {
  return joined(arc, start, [&](const ArcGeometry& shape, const ToolPose& begin) {
    return make_arc(shape, begin, start.tolerance_mm);
  });
}

Expected<CurveList> curves_of(const Arc3Geometry& arc, const CurveStart& start) {
  return joined(arc, start, make_arc3);
}

Expected<CurveList> curves_of(const NurbsGeometry& nurbs, const CurveStart& start) {
  return make_nurbs(nurbs, start);
}

Expected<CurveList> curves_of(const PathTargetGeometry& move, const CurveStart& start) {
  const auto target = checked(move.target, "target");
  if (!target) return tl::unexpected(target.error());
  return listed(make_line(start.pose, *target));
}

Expected<CurveList> curves_of(const JointTargetGeometry& move, const CurveStart& start) {
  return listed(make_joint_line(start.joints, move.joints));
}

}  // namespace

Expected<> check_start(const Vector& tip, const CurveStart& start) {
  const double gap_mm = distance(tip, start.pose.tip);
  if (gap_mm <= kStartTolerance_mm) return {};
  return refuse("the move starts " + text(gap_mm) + " mm from where the queue ends (" + text(start.pose.tip[0]) + ", " +
                text(start.pose.tip[1]) + ", " + text(start.pose.tip[2]) + "); at most " + text(kStartTolerance_mm) +
                " mm is allowed: go to its start by MoveToPathTarget first, or begin it where the queue ends");
}

Expected<> check_start_axis(const Vector& axis, const CurveStart& start) {
  const double gap = distance(axis, start.pose.axis);
  if (gap <= kStartTolerance_axis) return {};
  return refuse("the move starts with a tool axis " + text(gap) + " from that at the end of the queue (" +
                text(start.pose.axis[0]) + ", " + text(start.pose.axis[1]) + ", " + text(start.pose.axis[2]) +
                "); at most " + text(kStartTolerance_axis) +
                " is allowed: turn the tool by MoveToPathTarget first, or begin with the axis that it has");
}

}  // namespace curves

Expected<std::vector<std::unique_ptr<const Curve>>> make_curves(const Move& move, const CurveStart& start) {
  CurveStart begin = start;
  begin.tolerance_mm = move.tolerance_mm;
  if (!is_joint_move(move.geometry)) {
    const auto pose = curves::checked(start.pose, "end of the queue");
    if (!pose) return tl::unexpected(pose.error());
    begin.pose = *pose;
  }
  return std::visit([&](const auto& geometry) { return curves::curves_of(geometry, begin); }, move.geometry);
}

}  // namespace rmac
