#include "joins/blend.hpp"

#include <algorithm>
#include <cmath>

#include "curves/nurbs_curve.hpp"
#include "joins/blend_spline.hpp"
#include "joins/pose_derivatives.hpp"
#include "path/part_of.hpp"
#include "path/travel.hpp"

namespace rmac {
namespace {

/// A blend shorter than this each way is hardly faster than a stop, and strains the time law.
constexpr double kLeastReach_mm = kShortestBlended_mm / 2;
/// Lever of an axis that may not turn at all: what rounding leaves of it counts as nothing.
constexpr double kLongestLever_mm = 1e9;
constexpr int kTrials = 12;
/// A turn of the tangent below this is rounding, and what is left is a jump of curvature.
constexpr double kNoTurn = 1e-6;
/// The part of the tolerance that a turn may use on a blend that is long for the sake of curvature or of a gap.
constexpr double kTurnUnnoticed = 0.25;
constexpr double kLossUnnoticed_s = 1e-3;
/// A blend over a gap at a corner reaches so many times as far as that is wide, where its speed asks for it.
constexpr double kGapsAReach = 20;
/// Near a reversal (here from 155 degrees on) a blend is nearly a cusp; stopping loses no more.
constexpr double kReversal = 1.95;

struct Meeting {
  CurvePoint before, after;
};

/// By an axis' turn in rad times `lever_mm`, which brings the tolerance of the axis to that of the tip.
double difference(const CurvePoint& a, const CurvePoint& b, std::size_t order, double lever_mm) {
  double tip = 0, axis = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    tip += (a.d[order][c] - b.d[order][c]) * (a.d[order][c] - b.d[order][c]);
    axis += (a.d[order][c + 3] - b.d[order][c + 3]) * (a.d[order][c + 3] - b.d[order][c + 3]);
  }
  return std::max(std::sqrt(tip), lever_mm * std::sqrt(axis));
}

/// Where the tip rests, a step of path length is a turn in degrees, and no distance.
bool tip_moves(const CurvePoint& point) {
  return point.d[1][0] * point.d[1][0] + point.d[1][1] * point.d[1][1] + point.d[1][2] * point.d[1][2] > 0.5;
}

/// Joints' tangents on both sides of a corner.
struct Corner {
  const JointPoint& before;
  const JointPoint& after;
  const std::vector<JointLimits>& joints;
  double turn = 0;  ///< of the pose's tangent
  double feed_mm_s = 0;
};

/// No rest is asked for where they meet, both are seen through the same frames, and tip and axis are free.
bool may_meet(const PathSegment& before, const PathSegment& after) {
  if (before.demand().rest_after || after.demand().rest_before || before.map() != after.map()) return false;
  if (before.curve().in_joint_space() || after.curve().in_joint_space()) return false;
  const auto past_pole = [](const Curve& curve) { return &curve.programmed() != &curve; };
  return !past_pole(before.curve()) && !past_pole(after.curve());  // turns are not free there
}

/// What the joints allow along both lines.
struct CornerLimits {
  double acceleration = 1e30, jerk = 1e30;
};

CornerLimits corner_limits(const Corner& corner) {
  CornerLimits limits;
  for (std::size_t j = 0; j < corner.joints.size(); ++j) {
    const double along = std::max({std::abs(corner.before.d[1][j]), std::abs(corner.after.d[1][j]), 1e-12});
    limits.acceleration = std::min(limits.acceleration, corner.joints[j].max_acceleration / along);
    limits.jerk = std::min(limits.jerk, corner.joints[j].max_jerk / along);
  }
  return limits;
}

/// Time lost on the way from a state to the feed, against having the feed from the beginning (eq. 8).
double ramp_loss(double v, double a, double feed, const CornerLimits& limits) {
  const double j = limits.jerk;
  if (!(v < feed)) return v < feed * (1 + 1e-9) ? 0 : 1e30;
  const double most = std::min(std::sqrt(j * (feed - v) + a * a / 2), limits.acceleration);
  if (most < a) return 1e30;
  const double up = (most - a) / j, down = most / j;
  const double v1 = v + up * (a + most) / 2, v2 = feed - down * most / 2;
  const double hold = std::max(0.0, (v2 - v1) / most);
  const double length =
      up * (v + up * (a / 2 + up * j / 6)) + hold * (v1 + v2) / 2 + down * (v2 + down * (most / 2 - down * j / 6));
  return up + hold + down - length / feed;
}

/// Time lost at a corner that is passed by a shape, against passing it at the feed (eq. 7 and 8).
double loss(const Corner& corner, const CornerLimits& limits, const CornerShape& shape, double reach) {
  double cube = 0, square = 0;
  for (std::size_t j = 0; j < corner.joints.size(); ++j) {
    const double t0 = corner.before.d[1][j], t1 = corner.after.d[1][j];
    const double jerk = std::max(std::abs(shape.jerk_near * t0 + shape.jerk_far * t1),
                                 std::abs(shape.jerk_far * t0 + shape.jerk_near * t1));
    const double acceleration = std::max(shape.acceleration * std::abs(t1 - t0),
                                         shape.entry_acceleration * std::max(std::abs(t0), std::abs(t1)));
    cube = std::max(cube, jerk / corner.joints[j].max_jerk);
    square = std::max(square, acceleration / corner.joints[j].max_acceleration);
  }
  // Half the time on the blend.
  const double time =
      std::max({std::cbrt(reach * cube), std::sqrt(reach * square), reach * shape.entry_speed / corner.feed_mm_s});
  const double v = reach * shape.entry_speed / time, a = reach * shape.entry_acceleration / (time * time);
  return 2 * (time - reach / corner.feed_mm_s + ramp_loss(v, a, corner.feed_mm_s, limits));
}

struct Choice {
  CornerShape shape;
  double reach = 0;  ///< 0: a stop loses no more
};

/// The shape and reach that lose least; among those that lose the same, the shortest.
Choice least_loss(const Corner& corner, double tolerance, double room) {
  const CornerLimits limits = corner_limits(corner);
  Choice best;
  double least = 2 * ramp_loss(0, 0, corner.feed_mm_s, limits);
  for (const CornerShape& shape : corner_shapes()) {
    double reach = std::min(room, tolerance / (shape.deviation * corner.turn));
    for (int halving = 0; halving < 8; ++halving, reach *= 0.7) {
      const double lost = loss(corner, limits, shape, reach);
      if (lost < least - 1e-6) {
        least = lost;
        best = {shape, reach};
      } else if (lost <= least + 1e-6 && best.reach > reach) {
        best = {shape, reach};
      }
    }
  }
  return best;
}

/// No point of the blend is further from the programmed path than this, nor any of that from the blend (eq. 5 and 6).
double deviation_bound(const BlendSpline& spline, const PathSegment& before, const PathSegment& after, double reach,
                       double lever_mm) {
  constexpr int kSamples = 16;
  double tip = 0, axis = 0, bend_tip = 0, bend_axis = 0;
  CurvePoint point;
  for (int half = 0; half < 2; ++half) {
    for (int i = 0; i <= kSamples; ++i) {
      const double part = static_cast<double>(i) / kSamples;
      const double u = half == 0 ? part - 1 : part;
      const double s = half == 0 ? before.length() + reach * u : reach * u;
      if (pose_derivatives(half == 0 ? before : after, s, half == 0 ? -1 : 1, point) != KinematicsStatus::Ok)
        return 1e30;
      const auto value = spline.at(u);
      double d = 0, a = 0, d2 = 0, a2 = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        d += (value[c] - point.d[0][c]) * (value[c] - point.d[0][c]);
        a += (value[c + 3] - point.d[0][c + 3]) * (value[c + 3] - point.d[0][c + 3]);
        d2 += point.d[2][c] * point.d[2][c];
        a2 += point.d[2][c + 3] * point.d[2][c + 3];
      }
      tip = std::max(tip, d);
      axis = std::max(axis, a);
      bend_tip = std::max(bend_tip, d2);
      bend_axis = std::max(bend_axis, a2);
    }
  }
  // Between samples the distance can grow by h²/8 of its second derivative. The curves' own bend is taken a fifth
  // larger than at the samples.
  const double grow = 1.0 / (8 * kSamples * kSamples);
  const double square = 1.2 * reach * reach;
  const double tip_bound = std::sqrt(tip) + grow * (spline.largest_second(0, 3) + square * std::sqrt(bend_tip));
  const double axis_bound = std::sqrt(axis) + grow * (spline.largest_second(3, 6) + square * std::sqrt(bend_axis));
  return std::max(tip_bound, lever_mm * axis_bound);
}

std::shared_ptr<const Curve> as_curve(const BlendSpline& spline, const Meeting& ends) {
  bool axis_stays = true;
  for (std::size_t c = 3; c < 6; ++c) {
    axis_stays = axis_stays && ends.before.d[0][c] == ends.after.d[0][c] && ends.before.d[1][c] == 0 &&
                 ends.after.d[1][c] == 0 && ends.before.d[2][c] == 0 && ends.after.d[2][c] == 0;
  }
  const Vector axis{ends.before.d[0][3], ends.before.d[0][4], ends.before.d[0][5]};
  const auto space = std::make_shared<const curves::SpaceCurve>(spline.nurbs(axis_stays ? 3 : 6),
                                                                axis_stays ? NurbsSpace::Tip : NurbsSpace::Pose, axis);
  auto curve = curves::NurbsCurve::make(space, 0, space->spline().span_count());
  if (!curve) return nullptr;  // a reversal: the blend would stand still
  return std::move(*curve);
}

PathDemand common_demand(const PathDemand& a, const PathDemand& b) {
  const auto lower = [](double x, double y) { return x > 0 && y > 0 ? std::min(x, y) : std::max(x, y); };
  PathDemand demand;
  demand.feed_mm_s = std::min(a.feed_mm_s, b.feed_mm_s);
  demand.accel_rise_mm_s2 = lower(a.accel_rise_mm_s2, b.accel_rise_mm_s2);
  demand.accel_fall_mm_s2 = lower(a.accel_fall_mm_s2, b.accel_fall_mm_s2);
  demand.tolerance_mm = b.tolerance_mm;
  demand.deviation_mm = std::max(a.deviation_mm, b.deviation_mm);
  demand.tolerance_rad = b.tolerance_rad;
  demand.deviation_rad = std::max(a.deviation_rad, b.deviation_rad);
  return demand;
}

/// Lines between the two that a blend joins, which it takes the place of.
using Passed = std::span<const std::shared_ptr<const PathSegment>>;

double length_of(Passed over) {
  double sum = 0;
  for (const auto& line : over) sum += line->length();
  return sum;
}

/// How far corners between these lines are from the nearer one of their ends, and so from the way between these at
/// most.
double stray(Passed over, const CurvePoint& begin, const CurvePoint& end, double lever_mm) {
  double most = 0;
  CurvePoint corner;
  for (std::size_t i = 0; i + 1 < over.size(); ++i) {
    over[i]->curve().evaluate(over[i]->length(), 0, -1, corner);
    most = std::max(most, std::min(difference(corner, begin, 0, lever_mm), difference(corner, end, 0, lever_mm)));
  }
  return most;
}

std::shared_ptr<const PathSegment> as_segment(const std::shared_ptr<const Curve>& curve, const PathSegment& before,
                                              Passed over, const PathSegment& after, double reach,
                                              const std::vector<JointLimits>& joints) {
  std::vector<MoveStretch> stretches;
  const double rate = curve->length() / (2 * reach + length_of(over));
  PathDemand demand = common_demand(before.demand(), after.demand());
  double at = rate * reach;
  append_stretches(before, before.length() - reach, before.length(), 0, at, stretches);
  for (const auto& line : over) {
    append_stretches(*line, 0, line->length(), at, at + rate * line->length(), stretches);
    at += rate * line->length();
    demand = common_demand(line->demand(), demand);
  }
  append_stretches(after, 0, reach, at, curve->length(), stretches);
  auto segment = std::make_shared<PathSegment>(curve, before.map(), demand, std::move(stretches));
  JointPoint start;
  if (before.evaluate(before.length() - reach, 0, -1, start) != KinematicsStatus::Ok) return nullptr;
  double s_failed = 0;
  if (segment->resolve({start.d[0].data(), joints.size()}, s_failed) != KinematicsStatus::Ok) return nullptr;
  if (find_offence(*segment, joints)) return nullptr;
  return segment;
}

/// What may be missed: by the tip, and by a point of the tool axis so far from it.
struct Allowed {
  double tip_mm = 0, lever_mm = kLongestLever_mm;
};

/// What is left of the tolerances by all that a blend joins; none of the tip's where there is no blend.
Allowed tolerance_of(const PathSegment& before, Passed over, const PathSegment& after) {
  if (!may_meet(before, over.empty() ? after : *over.front())) return {};
  const PathDemand &a = before.demand(), &b = after.demand();
  double tip_mm = b.tolerance_mm - std::max(a.deviation_mm, b.deviation_mm);
  double axis_rad = b.tolerance_rad - std::max(a.deviation_rad, b.deviation_rad);
  for (std::size_t i = 0; i < over.size(); ++i) {
    if (!may_meet(*over[i], i + 1 < over.size() ? *over[i + 1] : after)) return {};
    const PathDemand& line = over[i]->demand();
    tip_mm = std::min(tip_mm, line.tolerance_mm - line.deviation_mm);
    axis_rad = std::min(axis_rad, line.tolerance_rad - line.deviation_rad);
  }
  return {tip_mm, tip_mm > kLongestLever_mm * axis_rad ? kLongestLever_mm : tip_mm / axis_rad};
}

/// Shape and reach to try first. `jump`: of curvature; `gap`: how far apart the two ends are.
Choice first_choice(const Corner& corner, double jump, double gap, double tolerance, double room) {
  const double feed = corner.feed_mm_s;
  double jerk = 1e30;
  for (const JointLimits& joint : corner.joints) jerk = std::min(jerk, joint.max_jerk);
  // Long enough for twice the feed, which an override may ask for.
  double smooth = 0;
  if (jump > 0) smooth = std::min(4 * 8 * feed * feed * feed * jump / jerk, std::sqrt(20 * tolerance / jump));
  if (gap > 0) smooth = std::max(smooth, 2 * feed * std::cbrt(8 * gap / jerk));
  smooth = std::min(smooth, room);
  // What turns by so little that neither tolerance nor time notices on that length is no corner.
  const CornerShape& plain = corner_shapes().front();
  if (smooth > 0 && corner.turn * smooth * plain.deviation <= kTurnUnnoticed * tolerance &&
      loss(corner, corner_limits(corner), plain, smooth) < kLossUnnoticed_s)
    return {plain, smooth};
  if (corner.turn <= kNoTurn) return {plain, room};
  Choice choice = least_loss(corner, tolerance - gap / 2, room);
  if (gap > 0) choice.reach = std::max(choice.reach, std::min(smooth, kGapsAReach * gap));
  return choice;
}

}  // namespace

Blend make_blend(const PathSegment& before, Passed over, const PathSegment& after, double room,
                 const std::vector<JointLimits>& joints) {
  const auto [tolerance, lever_mm] = tolerance_of(before, over, after);
  if (!(tolerance > 0)) return {};
  Meeting corner;
  JointPoint below, above;
  if (pose_derivatives(before, before.length(), -1, corner.before) != KinematicsStatus::Ok ||
      pose_derivatives(after, 0, 1, corner.after) != KinematicsStatus::Ok || !tip_moves(corner.before) ||
      !tip_moves(corner.after) || before.evaluate(before.length(), 1, -1, below) != KinematicsStatus::Ok ||
      after.evaluate(0, 1, 1, above) != KinematicsStatus::Ok)
    return {};

  const double gap = over.empty() ? 0 : difference(corner.before, corner.after, 0, lever_mm);
  const double strayed = stray(over, corner.before, corner.after, lever_mm);
  if (!(gap / 2 + strayed < tolerance)) return {};
  const double turn = difference(corner.before, corner.after, 1, lever_mm);
  double tip_turn = 0;
  for (std::size_t c = 0; c < 3; ++c)
    tip_turn += (corner.after.d[1][c] - corner.before.d[1][c]) * (corner.after.d[1][c] - corner.before.d[1][c]);
  if (tip_turn > kReversal * kReversal) return {};
  const double feed = std::min(before.demand().feed_mm_s, after.demand().feed_mm_s);
  Choice choice = first_choice({below, above, joints, turn, feed}, difference(corner.before, corner.after, 2, lever_mm),
                               gap, tolerance - strayed, room);
  for (int trial = 0; trial < kTrials && choice.reach > kLeastReach_mm; ++trial) {
    Meeting ends;
    if (pose_derivatives(before, before.length() - choice.reach, -1, ends.before) != KinematicsStatus::Ok ||
        pose_derivatives(after, choice.reach, 1, ends.after) != KinematicsStatus::Ok)
      return {};
    const BlendSpline spline(ends.before, ends.after, choice.reach, choice.shape);
    const double bound = deviation_bound(spline, before, after, choice.reach, lever_mm) + strayed;
    if (bound > tolerance) {
      choice.reach *= std::clamp(0.99 * tolerance / bound, 0.5, 0.99);
      continue;
    }
    if (const auto curve = as_curve(spline, ends)) {
      if (auto segment = as_segment(curve, before, over, after, choice.reach, joints))
        return {choice.reach, std::move(segment)};
    }
    // At a joint's limit a blend that swings out leaves the travel, and one that does not may keep it.
    if (choice.shape.lobe == 0) return {};
    choice.shape = corner_shapes().front();
    choice.reach = std::min(choice.reach, tolerance / (choice.shape.deviation * turn));
  }
  return {};
}

}  // namespace rmac
