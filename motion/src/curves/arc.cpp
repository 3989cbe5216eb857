#include <algorithm>
#include <numbers>

#include "axis_turn.hpp"
#include "vector.hpp"

namespace rmac::curves {
namespace {

/// Ends nearer than this meet, and what keeps a plane to so much keeps it.
constexpr double kArcTolerance_mm = 1e-3;
/// Two radii may differ by this much, or by half of the move's tolerance, where the client's start, end and centre do
/// not quite fit each other: coordinates to a micrometre, six of them, make up to 2.83 µm.
constexpr double kRounded_mm = 3e-3;

/// A circle's stretch, seen from its start so that large radii lose no digits (docs/derivations/curves.md, eq. 3); a
/// helix's with a rise.
struct Circle {
  Vector start{};
  Vector outward{};  ///< unit, from the centre to the start
  Vector ahead{};    ///< unit tangent at the start
  Vector rise{};     ///< mm, along the axis, of the whole sweep
  double radius_mm = 0;
  double sweep_rad = 0;

  [[nodiscard]] double length() const noexcept { return std::hypot(radius_mm * sweep_rad, norm(rise)); }
  /// In the plane: without the rise.
  [[nodiscard]] Vector at(double angle) const noexcept {
    const double half = std::sin(angle / 2);
    return along(along(start, radius_mm * std::sin(angle), ahead), -2 * radius_mm * half * half, outward);
  }
};

class ArcCurve final : public Curve {
 public:
  ArcCurve(const Circle& circle, const AxisTurn& turn)
      : circle_(circle),
        length_mm_(circle.length()),
        turn_rad_mm_(circle.sweep_rad / length_mm_),
        climb_(scaled(1 / length_mm_, circle.rise)),
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
    const double rate = turn_rad_mm_;
    const double half_sine = std::sin(s * rate / 2);
    const double half_cosine = std::cos(s * rate / 2);
    const double sine = 2 * half_sine * half_cosine;
    const double fall = 2 * half_sine * half_sine;  // 1 - cos
    const double cosine = 1 - fall;
    for (std::size_t c = 0; c < 3; ++c) {
      const double u = circle_.outward[c];
      const double v = circle_.ahead[c];
      point.d[0][c] = circle_.start[c] + r * (v * sine - u * fall) + s * climb_[c];
      if (order >= 1) point.d[1][c] = r * rate * (v * cosine - u * sine) + climb_[c];
      if (order >= 2) point.d[2][c] = -r * rate * rate * (v * sine + u * cosine);
      if (order >= 3) point.d[3][c] = -r * rate * rate * rate * (v * cosine - u * sine);
    }
    turn_.evaluate(s, length_mm_, order, point);
  }

 private:
  Circle circle_;
  double length_mm_;
  double turn_rad_mm_;  ///< about the axis, by arc length
  Vector climb_;        ///< along the axis, by arc length
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

Expected<> check_numbers(const ArcGeometry& arc) {
  if (!finite(arc.center) || !finite(arc.normal)) {
    return refuse("the arc's centre or normal holds a number that is not finite");
  }
  if (!(norm(arc.normal) > 1e-6)) return refuse("the arc's normal has no length");
  if (arc.rotation != 1 && arc.rotation != -1) {
    return refuse("the arc's rotation is " + std::to_string(arc.rotation) +
                  "; it must be 1 (counter-clockwise about the normal) or -1");
  }
  if (arc.turns < 0 || arc.turns > ArcGeometry::kMostTurns) {
    return refuse("the arc's Turns are " + std::to_string(arc.turns) + "; 0 to " +
                  std::to_string(ArcGeometry::kMostTurns) + " whole turns may be added");
  }
  return {};
}

}  // namespace

Expected<CurvePtr> make_arc(const ArcGeometry& arc, const ToolPose& start, double tolerance_mm) {
  if (auto fine = check_numbers(arc); !fine) return tl::unexpected(fine.error());
  const Vector normal = unit(arc.normal);
  const double height = dot(difference(arc.end.tip, start.tip), normal);
  // What the end is off the start's plane, along the axis, is a helix's rise.
  const Vector end = along(arc.end.tip, -height, normal);
  const double chord = distance(start.tip, end);
  if (arc.closed && chord > kArcTolerance_mm) {
    return refuse("the arc is closed, but its end is " + text(chord) +
                  " mm from its start, seen along its axis; give the start as its end, or for a helix the place above "
                  "or below it");
  }
  const bool whole = chord <= kArcTolerance_mm;
  if (whole && !arc.closed && arc.turns == 0) {
    // What rounding left of a short arc. Its sweep, next to nothing or a full turn, is not in its data.
    if (std::abs(height) <= kArcTolerance_mm) return make_line(start, arc.end);
    return refuse(
        "the arc's start and end coincide (" + text(chord) +
        " mm apart, seen along its axis); a full circle needs Closed, a helix of whole turns Closed or Turns");
  }
  const auto radius_of = [&](const Vector& point) {
    const Vector spoke = difference(point, arc.center);
    return norm(along(spoke, -dot(spoke, normal), normal));
  };
  const double start_radius = radius_of(start.tip), end_radius = radius_of(end);
  const double allowed = std::max(kRounded_mm, tolerance_mm / 2) + 1e-6 * start_radius;
  if (std::abs(start_radius - end_radius) > allowed) {
    return refuse("the arc's start has radius " + text(start_radius) + " mm about its centre and its end " +
                  text(end_radius) + " mm, a difference of " + text(std::abs(start_radius - end_radius)) + " mm; " +
                  text(allowed) + " mm is allowed");
  }
  auto circle = circle_about(arc.center, scaled(arc.rotation, normal), start.tip, end, whole);
  if (!circle) return tl::unexpected(circle.error());
  // Where the ends nearly meet, a centre moved to fit both can lie far off: the amounts above do not show it.
  const double off = stray(*circle, arc.center, normal, start.tip);
  if (off > std::max(2 * kRounded_mm, tolerance_mm / 2) + 2e-6 * start_radius) {
    return refuse("the arc's start and end fit no circle about its centre: the best through both is " + text(off) +
                  " mm off; give more digits");
  }
  const double turn_rad = 2 * std::numbers::pi;
  circle->sweep_rad = (whole && !arc.closed ? 0 : circle->sweep_rad) + turn_rad * arc.turns;
  circle->rise = scaled(height, normal);
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
