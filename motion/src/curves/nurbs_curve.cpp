#include "nurbs_curve.hpp"

#include <algorithm>
#include <cmath>

#include "nurbs_check.hpp"
#include "vector.hpp"

namespace rmac::curves {
namespace {

/// Tangents that differ by more than this make a corner, where the curve is cut.
constexpr double kCorner = 1e-7;

Expected<> check_nurbs_start(const CurvePoint& point, NurbsSpace space, const CurveStart& start) {
  if (space == NurbsSpace::Joint) {
    for (std::size_t j = 0; j < start.joints.size(); ++j) {
      const double gap = std::abs(point.d[0][j] - start.joints[j]);
      if (!(gap <= kStartTolerance_mm)) {
        return refuse("the curve starts with joint " + std::to_string(j) + " at " + text(point.d[0][j]) +
                      ", the queue ends with it at " + text(start.joints[j]) + ", " + text(gap) + " away; at most " +
                      text(kStartTolerance_mm) + " is allowed");
      }
    }
    return {};
  }
  if (auto sound = check_start({point.d[0][0], point.d[0][1], point.d[0][2]}, start); !sound) return sound;
  return check_start_axis({point.d[0][3], point.d[0][4], point.d[0][5]}, start);
}

/// Moves the first control points so that the curve begins exactly where the queue ends: as many as carry tangent and
/// curvature along unchanged, and never one that shapes the end. By the convex hull property no point of the curve
/// moves further than the gap, which has been found to be at most a micrometre.
void close_gap(const CurvePoint& point, NurbsSpace space, const CurveStart& start, Nurbs& nurbs) {
  const std::size_t count = nurbs.points.size();
  const auto degree = static_cast<std::size_t>(nurbs.degree);
  const bool clamped = nurbs.knots.front() == nurbs.knots[degree];
  const std::size_t shifted = clamped ? std::clamp<std::size_t>(count / 2, 1, 3) : degree;
  if (shifted + degree > count && !clamped) return;
  std::vector<double> gap(nurbs.dimension, 0.0);
  for (std::size_t c = 0; c < nurbs.dimension; ++c) {
    if (space == NurbsSpace::Joint) {
      gap[c] = start.joints[c] - point.d[0][c];
    } else if (c < 3) {
      gap[c] = start.pose.tip[c] - point.d[0][c];
    } else {
      // The point holds the normalised axis; the control points hold it at the length the client gave it.
      const auto& axis = nurbs.points.front();
      const double length = std::hypot(axis[3], axis[4], axis[5]);
      gap[c] = (start.pose.axis[c - 3] - point.d[0][c]) * length;
    }
  }
  for (std::size_t i = 0; i < shifted; ++i) {
    for (std::size_t c = 0; c < nurbs.dimension; ++c) nurbs.points[i][c] += gap[c];
  }
}

/// The curve turns a corner at the start of `span`.
bool corner_before(const SpaceCurve& curve, std::size_t span) {
  if (curve.spline().multiplicity(span) < curve.spline().degree()) return false;
  CurvePoint before;
  CurvePoint after;
  curve.tangent(span - 1, curve.spline().span_width(span - 1), before);
  curve.tangent(span, 0, after);
  const auto jump = [&](std::size_t first, std::size_t last) {
    double sum = 0;
    double size = 0;
    for (std::size_t c = first; c < last; ++c) {
      sum += (after.d[1][c] - before.d[1][c]) * (after.d[1][c] - before.d[1][c]);
      size += before.d[1][c] * before.d[1][c];
    }
    return std::sqrt(sum) / std::max(1.0, std::sqrt(size));
  };
  if (curve.space() == NurbsSpace::Joint) return jump(0, curve.dimension()) > kCorner;
  return jump(0, 3) > kCorner || jump(3, 6) > kCorner;
}

/// A straight span, by its ends.
Expected<CurvePtr> line_along(const SpaceCurve& curve, std::size_t span) {
  CurvePoint begin;
  CurvePoint end;
  curve.evaluate(span, 0, 0, begin);
  curve.evaluate(span, curve.spline().span_width(span), 0, end);
  if (curve.space() == NurbsSpace::Joint) {
    return make_joint_line({begin.d[0].data(), curve.dimension()}, {end.d[0].data(), curve.dimension()});
  }
  const auto pose = [](const CurvePoint& point) {
    const auto& d = point.d[0];
    return ToolPose{{d[0], d[1], d[2]}, {d[3], d[4], d[5]}};
  };
  return make_line(pose(begin), pose(end));
}

/// Appends spans [begin, end), between which there is no corner. A straight one whose parameter stands still somewhere
/// (where control points coincide) is travelled as the line it is (docs/derivations/curves.md, section 7). Which are
/// straight, and which stay in one place, is told by the curve as it was `given`, before its start was moved to where
/// the queue ends.
Expected<> append(const SpaceCurve& given, const std::shared_ptr<const SpaceCurve>& curve, std::size_t begin,
                  std::size_t end, CurveList& curves) {
  while (begin < end) {
    auto part = NurbsCurve::make(curve, begin, end);
    if (part) {
      curves.push_back(std::move(*part));
      return {};
    }
    const LengthTable::Flaw flaw = part.error();
    if (!given.straight(flaw.span) && !given.stays(flaw.span)) {
      return refuse("the curve stands still at parameter " + text(curve->spline().parameter(flaw.span, flaw.t)) +
                    " (its first derivative vanishes: control points that coincide, or a cusp) and is not straight "
                    "there, so its curvature may have no bound; give each control point a place of its own, such as a "
                    "third of the way to the next, or cut the curve at the cusp");
    }
    if (flaw.span > begin) {
      if (auto before = append(given, curve, begin, flaw.span, curves); !before) return before;
    }
    auto line = line_along(*curve, flaw.span);
    if (!line) return tl::unexpected(line.error());
    if (*line) curves.push_back(std::move(*line));
    begin = flaw.span + 1;
  }
  return {};
}

}  // namespace

tl::expected<CurvePtr, LengthTable::Flaw> NurbsCurve::make(std::shared_ptr<const SpaceCurve> curve, std::size_t first,
                                                           std::size_t last) {
  std::unique_ptr<NurbsCurve> result(new NurbsCurve(std::move(curve)));
  const SpaceCurve& space = *result->curve_;
  const BSpline& spline = space.spline();
  const auto speed = [&](std::size_t span, double t) { return space.speed(span, t); };
  std::vector<double> knots{0};
  for (std::size_t span = first; span < last; ++span) {
    if (span > first && spline.degree() < spline.multiplicity(span) + 3) {
      result->breaks_.push_back(result->table_.length());
    }
    const auto flaw = result->table_.add_span(span, spline.span_width(span), space.least_speed(span), speed);
    if (flaw) return tl::unexpected(*flaw);
    knots.push_back(result->table_.length());
  }
  // Where the speed dips, at a near-cusp, the table's pieces crowd: they show the planner's grid where to look.
  result->nodes_ = curvature_nodes(*result, knots, result->table_.starts());
  return result;
}

void NurbsCurve::evaluate(double s, int order, int side, CurvePoint& point) const noexcept {
  const auto place = table_.locate(std::clamp(s, 0.0, table_.length()), side);
  curve_->evaluate(place.span, place.t, order, point);
  curve_->to_arc_length(order, point);
}

Expected<CurveList> make_nurbs(const NurbsGeometry& geometry, const CurveStart& start) {
  if (auto sound = check_nurbs(geometry, start.joints.size()); !sound) return tl::unexpected(sound.error());
  Nurbs nurbs = geometry.curve;
  const SpaceCurve given(nurbs, geometry.space, start.pose.axis);
  if (const auto place = given.vanishing_axis()) {
    return refuse("the tool axis of the NURBS shrinks to nothing near parameter " +
                  text(given.spline().parameter(place->span, place->t)) +
                  "; give control points whose axes differ by less");
  }
  CurvePoint first;
  given.evaluate(0, 0, 0, first);
  if (auto joined = check_nurbs_start(first, geometry.space, start); !joined) return tl::unexpected(joined.error());
  close_gap(first, geometry.space, start, nurbs);

  const auto curve = std::make_shared<const SpaceCurve>(nurbs, geometry.space, start.pose.axis);
  if (curve->rests()) return CurveList{};
  CurveList curves;
  const std::size_t spans = curve->spline().span_count();
  for (std::size_t begin = 0; begin < spans;) {
    std::size_t end = begin + 1;
    while (end < spans && !corner_before(*curve, end)) ++end;
    if (auto appended = append(given, curve, begin, end, curves); !appended) return tl::unexpected(appended.error());
    begin = end;
  }
  return curves;
}

}  // namespace rmac::curves
