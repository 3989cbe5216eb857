#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "path/join.hpp"
#include "path/part_of.hpp"
#include "path/pole_passage.hpp"
#include "path/travel.hpp"
#include "path/trimmed_curve.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/move_name.hpp"
#include "rmac/motion/planner.hpp"

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

/// The joint that a move leaves outside of its travel, where it stood further out before.
std::optional<TravelOffence> still_outside(std::span<const double> excess, const PathSegment& last) {
  JointPoint end;
  const auto joint = std::find_if(excess.begin(), excess.end(), [](double amount) { return amount != 0; });
  if (joint == excess.end() || last.evaluate(last.length(), 0, -1, end) != KinematicsStatus::Ok) return std::nullopt;
  const auto index = static_cast<std::size_t>(joint - excess.begin());
  return TravelOffence{index, end.d[0][index], *joint, last.length()};
}

/// What of a move's segments lies from `from_mm` on.
std::vector<std::shared_ptr<const PathSegment>> rest_of(std::vector<std::shared_ptr<const PathSegment>> segments,
                                                        double from_mm) {
  constexpr double kNothing_mm = 1e-6;
  std::vector<std::shared_ptr<const PathSegment>> rest;
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

Expected<std::vector<std::shared_ptr<const PathSegment>>> PathBuilder::build(const Move& move, double from_mm) {
  const auto* nurbs = std::get_if<NurbsGeometry>(&move.geometry);
  const bool joint_move = std::holds_alternative<JointTargetGeometry>(move.geometry) ||
                          (nurbs != nullptr && nurbs->space == NurbsSpace::Joint);
  const bool positioning = std::holds_alternative<JointTargetGeometry>(move.geometry) ||
                           std::holds_alternative<PathTargetGeometry>(move.geometry);
  if (auto checked = check_demand(move, joint_move); !checked) return tl::unexpected(checked.error());
  auto curves = make_curves(move, {end_pose_, end_joints_});
  if (!curves) return tl::unexpected(curves.error());
  if (curves->empty()) return std::vector<std::shared_ptr<const PathSegment>>{};

  std::vector<std::shared_ptr<const PathSegment>> segments;
  std::vector<double> joints = end_joints_;
  std::vector<double> excess = excess_of(joints, model_.joints);
  PathDemand demand;
  demand.feed_mm_s = move.feed_mm_s;
  demand.accel_rise_mm_s2 = move.accel_rise_mm_s2;
  demand.accel_fall_mm_s2 = move.accel_fall_mm_s2;
  demand.tolerance_mm = move.tolerance_mm;
  demand.joint_speed_fraction = move.joint_speed_fraction;
  MoveStretch stretch;
  stretch.move_id = move.id;

  // One smooth curve in, one segment out; a curve is cut where the joints' acceleration would have to jump.
  const auto append = [&](const std::shared_ptr<const Curve>& curve) -> Expected<> {
    const auto segment = std::make_shared<PathSegment>(curve, map_, demand, std::vector{stretch});
    double s = 0;
    if (const auto status = segment->resolve(joints, s); status != KinematicsStatus::Ok) {
      return tl::unexpected(unreachable(move, *segment, status, s));
    }
    auto found = find_offence(*segment, model_.joints, excess);
    if (!found && stretch.last_of_move) found = still_outside(excess, *segment);
    if (found) {
      const TravelOffence& offence = *found;
      const JointLimits& joint = model_.joints[offence.joint];
      return failure(
          MinorCode::TravelLimit,
          text("%s takes joint %s to %.4f %s, %.4f %s beyond its limit of %.4f %s, %.4f mm along the "
               "move; nothing was queued",
               move_name(move.id).c_str(), joint.name.c_str(), offence.position, unit(joint), std::abs(offence.amount),
               unit(joint), offence.amount > 0 ? joint.max : joint.min, unit(joint), stretch.s_begin_mm + offence.s));
    }
    const auto end = segment->joints_at_node(curve->nodes().size() - 1);
    std::copy(end.begin(), end.end(), joints.begin());
    stretch.s_begin_mm += segment->length();
    segments.push_back(segment);
    return {};
  };

  const auto append_piece = [&](const std::shared_ptr<const Curve>& piece, bool last) {
    demand.rest_before = positioning && segments.empty();
    demand.rest_after = positioning && last;
    stretch.last_of_move = last;
    return append(piece);
  };

  const auto lay = [&](const std::shared_ptr<const Curve>& curve, bool last) -> Expected<> {
    if (curve->breaks().empty()) return append_piece(curve, last);
    std::vector<double> cuts{0};
    PathSegment probe(curve, map_, demand, {stretch});
    double s = 0;
    if (const auto status = probe.resolve(joints, s); status != KinematicsStatus::Ok)
      return tl::unexpected(unreachable(move, probe, status, s));
    JointPoint below, above;
    for (const double at : curve->breaks()) {
      if (probe.evaluate(at, 2, -1, below) != KinematicsStatus::Ok ||
          probe.evaluate(at, 2, 1, above) != KinematicsStatus::Ok)
        continue;
      if (!passable(below, above, model_.joints, std::max(demand.feed_mm_s, 1.0), model_.period_s)) cuts.push_back(at);
    }
    cuts.push_back(curve->length());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const bool whole = cuts.size() == 2;
      auto piece = whole ? curve : std::make_shared<TrimmedCurve>(curve, cuts[i], cuts[i + 1]);
      if (auto appended = append_piece(piece, last && i + 2 == cuts.size()); !appended) return appended;
    }
    return {};
  };

  const auto pass_pole = [&](const std::shared_ptr<const Curve>& near, const PathSegment* before,
                             const std::shared_ptr<const Curve>& next, bool last) -> Expected<> {
    const auto passages = pole_passages(near, {joints, before}, next, map_, model_.joints);
    Expected<> refused = tl::unexpected(beyond_pole(move, *near, stretch.s_begin_mm, kPoleDeviation));
    for (const auto& passage : passages) {
      const auto [deviation, s] = passage->largest_deviation();
      if (deviation > kPoleDeviation) {
        refused = tl::unexpected(beyond_pole(move, *near, stretch.s_begin_mm + s, deviation));
      } else if (auto appended = append_piece(passage, last); appended || &passage == &passages.back()) {
        return appended;
      }
    }
    return refused;
  };

  const auto lay_past_pole = [&](const std::shared_ptr<const Curve>& curve, bool last) -> Expected<> {
    Vector pole{};
    if (joint_move || !model_.kinematics->pole(pole)) return lay(curve, last);
    const PoleMap map = map_pole(*curve, apply_to_vector(inverse(map_->frames().part), pole));
    if (map.passages.empty() && map.nodes.empty()) return lay(curve, last);
    const double length = curve->length();
    const auto part = [&](double begin, double end) -> std::shared_ptr<const Curve> {
      return std::make_shared<TrimmedCurve>(curve, begin, end, Direction::Forward, &map.nodes);
    };
    double at = 0;
    for (std::size_t i = 0; i <= map.passages.size(); ++i) {
      const double until = i < map.passages.size() ? map.passages[i].begin : length;
      if (until > at) {
        if (auto laid = lay(part(at, until), last && until == length); !laid) return laid;
      }
      if (i == map.passages.size()) break;
      const auto [begin, end] = map.passages[i];
      const double next_end = i + 1 < map.passages.size() ? map.passages[i + 1].begin : length;
      const auto next = end < next_end ? part(end, next_end) : nullptr;
      const PathSegment* const before = until > at ? segments.back().get() : nullptr;
      if (auto passed = pass_pole(part(begin, end), before, next, last && end == length); !passed) return passed;
      at = end;
    }
    return {};
  };

  for (auto& owned : *curves) {
    const std::shared_ptr<const Curve> curve = std::move(owned);
    if (joint_move) {
      // Speed along a joint path: what the slowest joint allows at the move's fraction; the time law bounds each joint
      // again, point by point.
      demand.feed_mm_s = std::numeric_limits<double>::infinity();
      CurvePoint point;
      double feed = 0;
      for (const double s : curve->nodes()) {
        curve->evaluate(s, 1, s > 0 ? -1 : 1, point);
        double here = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < model_.joints.size(); ++j) {
          if (point.d[1][j] != 0)
            here = std::min(here, model_.joints[j].max_speed * move.joint_speed_fraction / std::abs(point.d[1][j]));
        }
        feed = std::max(feed, here);
      }
      demand.feed_mm_s = feed;
    }
    if (auto laid = lay_past_pole(curve, &owned == &curves->back()); !laid) return tl::unexpected(laid.error());
  }
  end_joints_ = std::move(joints);
  end_pose_ = segments.back()->pose(segments.back()->length());
  return from_mm > 0 ? rest_of(std::move(segments), from_mm) : segments;
}

}  // namespace rmac
