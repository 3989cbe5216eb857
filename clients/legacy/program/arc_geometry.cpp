#include "clients/legacy/program/arc_geometry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "clients/legacy/program/refusal.hpp"

namespace rmac::legacy {

namespace {

/// A radius may be too small by this much to reach the end, as in rs274 (0.00005 inch).
constexpr double kShortRadius_mm = 0.00127;
/// rs274 refuses radii that differ by more than the first, or by more than the second and a thousandth.
constexpr double kMostOff_mm = 0.5, kOff_mm = 0.005, kRelative = 1e-3;
/// By so much more than its radii differ may an arc stray from the circle that was written.
constexpr double kStray_mm = 5e-4;
/// The appliance takes ends that are nearer than a micrometre for one place; what is written is rounded.
constexpr double kClosed_mm = 1.001e-3;
/// A turn so short is a full one, as in rs274.
constexpr double kFullCircle_rad = 1e-6;

struct Chord {
  double first, second, length;
};

Chord chord_of(const Point& start, const Point& end, const Plane& plane) {
  const double first = end.at(plane.first) - start.at(plane.first),
               second = end.at(plane.second) - start.at(plane.second);
  return {first, second, std::hypot(first, second)};
}

double distance(const Point& a, const Point& b, const Plane& plane) {
  return chord_of(a, b, plane).length;
}

void require_radii(double to_start, double to_end, std::size_t place) {
  if (to_start <= kClosed_mm) refuse(place, "the arc's centre is where it begins");
  const double off = std::abs(to_start - to_end);
  if (off <= kMostOff_mm && (off <= kOff_mm || off <= kRelative * to_start)) return;
  refuse(place,
         fmt::format(
             "the arc's centre is {:.6g} mm from its start and {:.6g} mm from its end; correct the centre or the end",
             to_start, to_end));
}

/// As rs274 has it, by the angles about the written centre alone: more than none, at most a little more than a turn.
double sweep_of(const Point& start, const Arc& arc, const Plane& plane) {
  const Chord from = chord_of(arc.centre, start, plane), to = chord_of(arc.centre, arc.end, plane);
  const double ahead =
      std::atan2(from.first * to.second - from.second * to.first, from.first * to.first + from.second * to.second);
  const double turn = arc.counter_clockwise ? ahead : -ahead;
  return turn > kFullCircle_rad ? turn : turn + kTurn_rad;
}

/// The centre that is as far from the start as from the end, moved along the chord. None where the arc would then leave
/// the circle that was written: the nearer the ends of a long arc, the farther its centre has to go.
std::optional<Point> evened_centre(const Point& start, const Arc& arc, const Plane& plane, double sweep) {
  const Chord chord = chord_of(start, arc.end, plane), spoke = chord_of(start, arc.centre, plane);
  if (chord.length <= kClosed_mm) return std::nullopt;
  const double shift = chord.length / 2 - (spoke.first * chord.first + spoke.second * chord.second) / chord.length;
  Point even = arc.centre;
  even.at(plane.first) += shift * chord.first / chord.length;
  even.at(plane.second) += shift * chord.second / chord.length;
  const double radius = distance(start, even, plane);
  // Up to half a turn it is between its ends that the arc is nearest and farthest; beyond, along the shift.
  if (sweep <= std::numbers::pi) return radius >= spoke.length / 2 ? std::optional(even) : std::nullopt;
  const double off = std::abs(spoke.length - distance(arc.end, arc.centre, plane));
  return std::abs(radius - spoke.length) + std::abs(shift) <= off + kStray_mm ? std::optional(even) : std::nullopt;
}

/// The arc on the circle about the written centre through the start, as far as it goes towards the end.
std::optional<Arc> on_circle(const Point& start, const Arc& written, const Plane& plane, double sweep) {
  const double radius = distance(start, written.centre, plane);
  Arc arc = written;
  arc.closed = std::abs(kTurn_rad - sweep) * radius <= kClosed_mm;
  if (!arc.closed && sweep * radius <= kClosed_mm) {
    if (arc.more_turns == 0) return std::nullopt;
    --arc.more_turns;
    arc.closed = true;
  }
  const double to_end = distance(written.end, written.centre, plane);
  for (const std::size_t axis : {plane.first, plane.second}) {
    const double centre = written.centre.at(axis);
    arc.end.at(axis) = arc.closed ? start.at(axis) : centre + (written.end.at(axis) - centre) * radius / to_end;
  }
  return arc;
}

}  // namespace

Point centre_by_radius(const Point& start, const Point& end, const Plane& plane, bool counter_clockwise, double radius,
                       std::size_t place) {
  const Chord chord = chord_of(start, end, plane);
  if (chord.length <= kClosed_mm)
    refuse(place, "an arc of a radius ends where it begins: the radius alone tells no circle; write I, J, K");
  const double half = chord.length / 2, amount = std::abs(radius);
  if (half - amount > kShortRadius_mm) {
    refuse(place,
           fmt::format("a radius of {:.6g} mm does not reach the end, which is {:.6g} mm away", amount, chord.length));
  }
  // A quarter turn left of the chord lies the centre of a short counter-clockwise arc.
  const double height = amount > half ? std::sqrt(amount * amount - half * half) : 0;
  const double left = counter_clockwise == (radius > 0) ? height : -height;
  Point centre = start;
  centre.at(plane.first) += chord.first / 2 - chord.second / chord.length * left;
  centre.at(plane.second) += chord.second / 2 + chord.first / chord.length * left;
  return centre;
}

double length_of(const Point& start, const Arc& arc, const Plane& plane) {
  const double sweep = (arc.closed ? kTurn_rad : sweep_of(start, arc, plane)) + arc.more_turns * kTurn_rad;
  return std::hypot(distance(start, arc.centre, plane) * sweep, arc.end.at(plane.normal) - start.at(plane.normal));
}

std::optional<Arc> arc_about(const Point& start, const Arc& written, const Plane& plane, std::size_t place) {
  const double to_start = distance(start, written.centre, plane), to_end = distance(written.end, written.centre, plane);
  require_radii(to_start, to_end, place);
  const double sweep = sweep_of(start, written, plane);
  if (const auto even = evened_centre(start, written, plane, sweep)) {
    Arc arc = written;
    arc.centre = *even;
    return arc;
  }
  return on_circle(start, written, plane, sweep);
}

}  // namespace rmac::legacy
