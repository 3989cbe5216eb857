#include "path/move_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "path/join.hpp"
#include "path/move_refusal.hpp"
#include "path/pose_loss.hpp"
#include "path/travel.hpp"
#include "path/trimmed_curve.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

bool is_positioning(const Move& move) {
  return std::holds_alternative<JointTargetGeometry>(move.geometry) ||
         std::holds_alternative<PathTargetGeometry>(move.geometry);
}

/// The joint that a move leaves outside of its travel, where it stood further out before.
std::optional<TravelOffence> still_outside(std::span<const double> excess, const PathSegment& last) {
  JointPoint end;
  const auto joint = std::find_if(excess.begin(), excess.end(), [](double amount) { return amount != 0; });
  if (joint == excess.end() || last.evaluate(last.length(), 0, -1, end) != KinematicsStatus::Ok) return std::nullopt;
  const auto index = static_cast<std::size_t>(joint - excess.begin());
  return TravelOffence{index, end.d[0][index], *joint, last.length()};
}

}  // namespace

MoveSegments::MoveSegments(const Move& move, const PlannerModel& model, std::shared_ptr<const PoseToJoints> map,
                           std::span<const double> start_joints)
    : move_(move),
      model_(model),
      map_(std::move(map)),
      joint_move_(is_joint_move(move.geometry)),
      positioning_(is_positioning(move)),
      joints_(start_joints.begin(), start_joints.end()),
      excess_(excess_of(joints_, model.joints)) {
  demand_.feed_mm_s = move.feed_mm_s;
  demand_.accel_rise_mm_s2 = move.accel_rise_mm_s2;
  demand_.accel_fall_mm_s2 = move.accel_fall_mm_s2;
  demand_.tolerance_mm = move.tolerance_mm;
  demand_.tolerance_rad = move.orientation_tolerance_deg * std::numbers::pi / 180;
  demand_.joint_speed_fraction = move.joint_speed_fraction;
  stretch_.move_id = move.id;
}

Expected<> MoveSegments::lay(const CurvePtr& curve, bool last) {
  if (joint_move_) {
    demand_.feed_mm_s = joint_feed(*curve);
    return lay_cut(curve, last);
  }
  Vector pole{};
  if (!model_.kinematics->pole(pole)) return lay_cut(curve, last);
  const PoleMap poles = map_pole(*curve, apply_to_vector(inverse(map_->frames().part), pole));
  if (poles.passages.empty() && poles.nodes.empty()) return lay_cut(curve, last);
  return lay_past_poles(curve, poles, last);
}

/// Speed along a joint path: what the slowest joint allows at the move's fraction. The time law bounds each joint
/// again, point by point.
double MoveSegments::joint_feed(const Curve& curve) const {
  CurvePoint point;
  double feed = 0;
  for (const double s : curve.nodes()) {
    curve.evaluate(s, 1, s > 0 ? -1 : 1, point);
    double here = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (point.d[1][j] != 0)
        here = std::min(here, model_.joints[j].max_speed * move_.joint_speed_fraction / std::abs(point.d[1][j]));
    }
    feed = std::max(feed, here);
  }
  return feed;
}

Expected<> MoveSegments::lay_past_poles(const CurvePtr& curve, const PoleMap& poles, bool last) {
  const auto part = [&](double begin, double end) -> CurvePtr {
    return std::make_shared<TrimmedCurve>(curve, begin, end, Direction::Forward, &poles.nodes);
  };
  const double length = curve->length();
  double laid_to = 0;
  for (std::size_t i = 0; i < poles.passages.size(); ++i) {
    const auto [begin, end] = poles.passages[i];
    const PathSegment* before = nullptr;
    if (begin > laid_to) {
      if (auto laid = lay_cut(part(laid_to, begin), false); !laid) return laid;
      before = segments_.back().get();
    }
    const double next_end = i + 1 < poles.passages.size() ? poles.passages[i + 1].begin : length;
    const CurvePtr next = end < next_end ? part(end, next_end) : nullptr;
    if (auto passed = pass_pole(part(begin, end), before, next, last && end == length); !passed) return passed;
    laid_to = end;
  }
  return laid_to < length ? lay_cut(part(laid_to, length), last) : Expected<>();
}

Expected<> MoveSegments::pass_pole(const CurvePtr& near, const PathSegment* before, const CurvePtr& next, bool last) {
  const double smoothed = demand_.tolerance_mm > 0 ? demand_.tolerance_rad : 0;
  const auto passages = pole_passages(near, {joints_, before, smoothed}, next, map_, model_.joints);
  Expected<> refused = tl::unexpected(beyond_pole(move_, *near, stretch_.s_begin_mm, kPoleDeviation));
  for (const auto& passage : passages) {
    const auto [deviation, s] = passage->largest_deviation();
    if (deviation > kPoleDeviation) {
      refused = tl::unexpected(beyond_pole(move_, *near, stretch_.s_begin_mm + s, deviation));
    } else if (auto appended = append(passage, last); appended || &passage == &passages.back()) {
      return appended;
    }
  }
  return refused;
}

Expected<> MoveSegments::lay_cut(const CurvePtr& curve, bool last) {
  if (curve->breaks().empty()) return append(curve, last);
  const auto cuts = cuts_of(curve);
  if (!cuts) return tl::unexpected(cuts.error());
  if (cuts->size() == 2) return append(curve, last);
  for (std::size_t i = 0; i + 1 < cuts->size(); ++i) {
    const auto piece = std::make_shared<TrimmedCurve>(curve, (*cuts)[i], (*cuts)[i + 1]);
    if (auto appended = append(piece, last && i + 2 == cuts->size()); !appended) return appended;
  }
  return {};
}

/// The curve's ends, and between them the breaks that the joints cannot pass at speed.
Expected<std::vector<double>> MoveSegments::cuts_of(const CurvePtr& curve) const {
  PathSegment probe(curve, map_, demand_, {stretch_});
  double s_failed = 0;
  if (const auto status = probe.resolve(joints_, s_failed); status != KinematicsStatus::Ok)
    return tl::unexpected(unreachable(move_, probe, status, s_failed));
  std::vector<double> cuts{0};
  JointPoint below, above;
  for (const double at : curve->breaks()) {
    if (probe.evaluate(at, 2, -1, below) != KinematicsStatus::Ok ||
        probe.evaluate(at, 2, 1, above) != KinematicsStatus::Ok)
      continue;
    if (!passable(below, above, model_.joints, std::max(demand_.feed_mm_s, 1.0), model_.period_s)) cuts.push_back(at);
  }
  cuts.push_back(curve->length());
  return cuts;
}

Expected<> MoveSegments::append(const CurvePtr& piece, bool last) {
  demand_.rest_before = positioning_ && segments_.empty();
  demand_.rest_after = positioning_ && last;
  demand_.positioning = positioning_;
  stretch_.last_of_move = last;
  const auto segment = std::make_shared<PathSegment>(piece, map_, demand_, std::vector{stretch_});
  double s_failed = 0;
  if (const auto status = segment->resolve(joints_, s_failed); status != KinematicsStatus::Ok)
    return tl::unexpected(unreachable(move_, *segment, status, s_failed));
  if (const auto lost = joint_move_ ? find_pose_loss(*segment) : std::nullopt)
    return tl::unexpected(without_pose(move_, *segment, *lost, model_.joints));
  auto offence = find_offence(*segment, model_.joints, excess_);
  if (!offence && last) offence = still_outside(excess_, *segment);
  if (offence)
    return tl::unexpected(beyond_travel(move_, *offence, model_.joints[offence->joint], stretch_.s_begin_mm));
  const auto end = segment->joints_at_node(segment->nodes().size() - 1);
  std::copy(end.begin(), end.end(), joints_.begin());
  stretch_.s_begin_mm += segment->length();
  segments_.push_back(segment);
  return {};
}

}  // namespace rmac
