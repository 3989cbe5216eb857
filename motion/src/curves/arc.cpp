#include <algorithm>
#include <numbers>

#include "axis_turn.hpp"
#include "vector.hpp"

namespace rmac::curves {
namespace {

/// Arcs may miss the given circle by this much where the client's start, end and centre do not quite fit each other.
constexpr double kArcTolerance_mm = 1e-3;

/// A circle's stretch, seen from its start so that large radii lose no digits (docs/derivations/curves.md, eq. 3).
struct Circle {
  Vector start{};
  Vector outward{};  ///< unit, from the centre to the start
  Vector ahead{};    ///< unit tangent at the start
  double radius_mm = 0;
  double sweep_rad = 0;

  [[nodiscard]] Vector at(double angle) const noexcept {
    const double half = std::sin(angle / 2);
    return along(along(start, radius_mm * std::sin(angle), ahead), -2 * radius_mm * half * half, outward);
  }
};

class ArcCurve final : public Curve {
 public:
  ArcCurve(const Circle& circle, const AxisTurn& turn)
      : circle_(circle),
        length_mm_(circle.radius_mm * circle.sweep_rad),
        turn_(turn),
        nodes_(even_nodes(length_mm_, std::max(circle.sweep_rad, turn.angle_rad()))) {}

  [[nodiscard]] bool in_joint_space() const noexcept override { return false; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return 6; }
  [[nodiscard]] double length() const noexcept override { return length_mm_; }
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return {}; }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return nodes_; }

  void evaluate(double s, int order, int /*side*/, CurvePoint& point) const noexcept override {
    s = std::clamp(s, 0.0, length_mm_);
    const double r = circle_.radius_mm;
    const double half_sine = std::sin(s / r / 2);
    const double half_cosine = std::cos(s / r / 2);
    const double sine = 2 * half_sine * half_cosine;
    const double fall = 2 * half_sine * half_sine;  // 1 - cos
    const double cosine = 1 - fall;
    for (std::size_t c = 0; c < 3; ++c) {
      const double u = circle_.outward[c];
      const double v = circle_.ahead[c];
      point.d[0][c] = circle_.start[c] + r * (v * sine - u * fall);
      if (order >= 1) point.d[1][c] = v * cosine - u * sine;
      if (order >= 2) point.d[2][c] = -(v * sine + u * cosine) / r;
      if (order >= 3) point.d[3][c] = -(v * cosine - u * sine) / (r * r);
    }
    turn_.evaluate(s, length_mm_, order, point);
  }

 private:
  Circle circle_;
  double length_mm_;
  AxisTurn turn_;
  std::vector<double> nodes_;
};

/// How far the circle's stretch strays from the circle about `center` and `normal` through `reference`.
double stray(const Circle& circle, const Vector& center, const Vector& normal, const Vector& reference) {
  const auto cylinder = [&](const Vector& point) {
    const Vector r = difference(point, center);
    const double height = dot(r, normal);
    return std::array{norm(along(r, -height, normal)), height};
  };
  const auto [radius, height] = cylinder(reference);
  double worst = 0;
  for (int i = 0; i <= 16; ++i) {
    const auto [r, h] = cylinder(circle.at(circle.sweep_rad * i / 16));
    worst = std::max(worst, std::hypot(r - radius, h - height));
  }
  return worst;
}

/// The circle through `start` (and `end`, unless closed) next to the given centre and normal, which a client knows to
/// its own digits only. `normal` unit, pointing so that the sweep is counter-clockwise.
Expected<Circle> circle_about(const Vector& center, Vector normal, const Vector& start, const Vector& end,
                              bool closed) {
  Vector middle = center;
  const Vector chord = difference(end, start);
  if (!closed) {
    normal = unit(along(normal, -dot(normal, chord) / dot(chord, chord), chord));
    const Vector to_chord = along(difference(start, center), 0.5, chord);
    middle = along(center, dot(to_chord, chord) / dot(chord, chord), chord);
  }
  middle = along(middle, dot(difference(start, middle), normal), normal);
  const Vector outward = difference(start, middle);
  Circle circle;
  circle.start = start;
  circle.radius_mm = norm(outward);
  if (!(circle.radius_mm > kStartTolerance_mm)) {
    return refuse("the arc's radius is " + text(circle.radius_mm) +
                  " mm: its start lies on the axis through its centre");
  }
  circle.outward = scaled(1 / circle.radius_mm, outward);
  circle.ahead = cross(normal, circle.outward);
  circle.sweep_rad = 2 * std::numbers::pi;
  if (!closed) {
    const Vector r = difference(end, middle);
    const double angle = std::atan2(dot(r, circle.ahead), dot(r, circle.outward));
    circle.sweep_rad = angle > 0 ? angle : angle + 2 * std::numbers::pi;
  }
  return circle;
}

Expected<CurvePtr> arc_on(const Circle& circle, const Vector& from, const Vector& to) {
  const auto turn = AxisTurn::between(from, to);
  if (!turn) return tl::unexpected(turn.error());
  return std::make_unique<ArcCurve>(circle, *turn);
}

}  // namespace

Expected<CurvePtr> make_arc(const ArcGeometry& arc, const ToolPose& start) {
  if (!finite(arc.center) || !finite(arc.normal)) {
    return refuse("the arc's centre or normal holds a number that is not finite");
  }
  if (!(norm(arc.normal) > 1e-6)) return refuse("the arc's normal has no length");
  if (arc.rotation != 1 && arc.rotation != -1) {
    return refuse("the arc's rotation is " + std::to_string(arc.rotation) +
                  "; it must be 1 (counter-clockwise about the normal) or -1");
  }
  const double chord = distance(start.tip, arc.end.tip);
  if (arc.closed && chord > kArcTolerance_mm) {
    return refuse("the arc is closed, but its end is " + text(chord) + " mm from its start; give the start as its end");
  }
  const Vector normal = unit(arc.normal);
  const Vector from_center = difference(start.tip, arc.center);
  const Vector end_from_center = difference(arc.end.tip, arc.center);
  const double start_height = dot(from_center, normal);
  const double end_height = dot(end_from_center, normal);
  const double start_radius = norm(along(from_center, -start_height, normal));
  const double end_radius = norm(along(end_from_center, -end_height, normal));
  const double allowed = kArcTolerance_mm + 1e-6 * start_radius;
  if (std::abs(start_height - end_height) > allowed) {
    return refuse("the arc's start and end are " + text(std::abs(start_height - end_height)) +
                  " mm apart along its normal; an arc stays in one plane (to " + text(allowed) + " mm)");
  }
  if (std::abs(start_radius - end_radius) > allowed) {
    return refuse("the arc's start has radius " + text(start_radius) + " mm about its centre and its end " +
                  text(end_radius) + " mm, a difference of " + text(std::abs(start_radius - end_radius)) + " mm; " +
                  text(allowed) + " mm is allowed");
  }
  // What rounding left of a short arc. Its sweep, next to nothing or a full turn, is not in its data.
  if (!arc.closed && chord <= kArcTolerance_mm) return make_line(start, arc.end);
  const auto circle = circle_about(arc.center, scaled(arc.rotation, normal), start.tip, arc.end.tip, arc.closed);
  if (!circle) return tl::unexpected(circle.error());
  // Where the ends nearly meet, a centre moved to fit both can lie far off: the amounts above do not show it.
  const double off = stray(*circle, arc.center, normal, start.tip);
  if (off > 2 * allowed) {
    return refuse("the arc's start and end fit no circle about its centre: the best through both is " + text(off) +
                  " mm off; give more digits");
  }
  return arc_on(*circle, start.axis, arc.end.axis);
}

Expected<CurvePtr> make_arc3(const Arc3Geometry& arc, const ToolPose& start) {
  if (!finite(arc.via)) return refuse("the arc's via point holds a number that is not finite");
  const Vector to_via = difference(arc.via, start.tip);
  const Vector to_end = difference(arc.end.tip, start.tip);
  if (std::max(norm(to_via), norm(to_end)) <= kArcTolerance_mm) return make_line(start, arc.end);
  const double shortest = std::min({norm(to_via), norm(to_end), distance(arc.via, arc.end.tip)});
  if (shortest <= kArcTolerance_mm) {
    return refuse("two of the arc's three points coincide (" + text(shortest) +
                  " mm apart); a full circle needs MoveAlongArc with Closed");
  }
  const Vector normal = cross(to_via, to_end);
  const double area = norm(normal);
  const double longest = std::max(norm(to_via), norm(to_end));
  // Circumradius = product of the sides over twice the area of the parallelogram.
  if (area * 2e6 * longest <= norm(to_via) * norm(to_end) * distance(arc.via, arc.end.tip)) {
    return refuse("the arc's three points lie on one line (via is " + text(area / norm(to_end)) +
                  " mm off the line from start to end); use MoveAlongLine");
  }
  const Vector center = along(start.tip, 0.5 / (area * area),
                              cross(along(scaled(dot(to_via, to_via), to_end), -dot(to_end, to_end), to_via), normal));
  const auto circle = circle_about(center, scaled(1 / area, normal), start.tip, arc.end.tip, false);
  if (!circle) return tl::unexpected(circle.error());
  return arc_on(*circle, start.axis, arc.end.axis);
}

}  // namespace rmac::curves
