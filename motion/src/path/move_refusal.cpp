#include "path/move_refusal.hpp"

#include <cmath>
#include <cstdio>

#include "path/pole_passage.hpp"
#include "rmac/motion/move_name.hpp"

namespace rmac {
namespace {

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

const char* unit(const JointLimits& joint) {
  return joint.type == JointType::Rotary ? "degrees" : "mm";
}

/// All of them, with their names.
std::string listed(std::span<const double> positions, const std::vector<JointLimits>& joints) {
  std::string list;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    list += text("%s%s at %.4f %s", j == 0 ? "" : ", ", joints[j].name.c_str(), positions[j], unit(joints[j]));
  }
  return list;
}

}  // namespace

Expected<> check_demand(const Move& move, bool joint_move) {
  const auto bad = [&](const char* what, double value, const char* rule) {
    return failure(MinorCode::InvalidParameterValue,
                   text("%s: %s is %g; %s", move_name(move.id).c_str(), what, value, rule));
  };
  if (!joint_move && !(move.feed_mm_s > 0 && std::isfinite(move.feed_mm_s))) {
    return bad("the feed", move.feed_mm_s * 60, "set one above 0 mm/min with SetFeedrate");
  }
  if (joint_move && !(move.joint_speed_fraction > 0 && move.joint_speed_fraction <= 1)) {
    return bad("the joint speed", move.joint_speed_fraction * 100, "it must be above 0 and at most 100 percent");
  }
  if (!(move.tolerance_mm >= 0)) return bad("the path tolerance", move.tolerance_mm, "it cannot be negative");
  if (!(move.orientation_tolerance_deg >= 0))
    return bad("the orientation tolerance", move.orientation_tolerance_deg, "it cannot be negative");
  if (!(move.accel_rise_mm_s2 >= 0))
    return bad("the path acceleration rise", move.accel_rise_mm_s2, "it cannot be negative");
  if (!(move.accel_fall_mm_s2 >= 0))
    return bad("the path acceleration fall", move.accel_fall_mm_s2, "it cannot be negative");
  return {};
}

Error unreachable(const Move& move, const PathSegment& segment, KinematicsStatus status, double s) {
  const ToolPose pose = segment.pose(s);
  const std::string place = text(
      "tip x %.4f y %.4f z %.4f, axis i %.4f j %.4f k %.4f (part frame), %.4f mm along the move", pose.tip[0],
      pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2], segment.stretches().front().s_begin_mm + s);
  const std::string name = move_name(move.id);
  if (status == KinematicsStatus::Singular) {
    return {MinorCode::TravelLimit,
            text("%s passes a singular pose of this mechanism at %s; keep away from it or reorient the part",
                 name.c_str(), place.c_str())};
  }
  return {MinorCode::TravelLimit, text("%s is out of this mechanism's reach at %s; no joint values give this pose",
                                       name.c_str(), place.c_str())};
}

Error beyond_travel(const Move& move, const TravelOffence& offence, const JointLimits& joint, double s_begin_mm) {
  return {MinorCode::TravelLimit,
          text("%s takes joint %s to %.4f %s, %.4f %s beyond its limit of %.4f %s, %.4f mm along the "
               "move; nothing was queued",
               move_name(move.id).c_str(), joint.name.c_str(), offence.position, unit(joint), std::abs(offence.amount),
               unit(joint), offence.amount > 0 ? joint.max : joint.min, unit(joint), s_begin_mm + offence.s)};
}

Error beyond_pole(const Move& move, const Curve& near, double s_mm, double deviation) {
  constexpr double kDegrees = 57.29577951308232;
  CurvePoint point;
  near.evaluate(near.length() / 2, 0, 1, point);
  return {
      MinorCode::TravelLimit,
      text("%s passes the pole, where the tool stands along a rotary axis, at tip x %.4f y %.4f z %.4f (part "
           "frame), %.4f mm along the move; the tool axis would leave the programmed one by %.3f degrees there, and "
           "may by %.3f; lead it past the pole further off, or straight through",
           move_name(move.id).c_str(), point.d[0][0], point.d[0][1], point.d[0][2], s_mm, deviation * kDegrees,
           kPoleDeviation * kDegrees)};
}

Error without_pose(const Move& move, const PathSegment& segment, double s, const std::vector<JointLimits>& joints) {
  JointPoint point;
  (void)segment.evaluate(s, 0, -1, point);
  return {MinorCode::TravelLimit, text("%s leads the joints to where the tool has no pose, %.4f along the move: ",
                                       move_name(move.id).c_str(), segment.stretches().front().s_begin_mm + s) +
                                      listed(point.d[0], joints) + "; nothing was queued"};
}

Error begins_without_pose(const Move& move, std::span<const double> positions, const std::vector<JointLimits>& joints) {
  return {MinorCode::TravelLimit,
          text("%s begins where the tool has no pose: ", move_name(move.id).c_str()) + listed(positions, joints) +
              "; lead the joints to where it has one, by JogJoint or by MoveToJointTarget with joints"};
}

Error not_taken(const Move& move, const Frame& tool) {
  return {
      MinorCode::UnsupportedOperation,
      text("%s: the kinematics of this mechanism cannot lead the tool in use, whose tip is at (%.4f, %.4f, %.4f) mm on "
           "the tool interface; its documentation says which tools it takes",
           move_name(move.id).c_str(), tool.p[0], tool.p[1], tool.p[2])};
}

}  // namespace rmac
