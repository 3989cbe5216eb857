#include "clients/legacy/rs274/arc_geometry.hpp"

#include <fmt/format.h>

#include <cmath>

#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// A radius may be too small by this much to reach the end, as in rs274 (0.00005 inch).
constexpr double kShortRadius_mm = 0.00127;
/// rs274 refuses radii that differ by more than the first, or by more than the second and a thousandth.
constexpr double kMostOff_mm = 0.5, kOff_mm = 0.005, kRelative = 1e-3;
/// Where the centre's way to the even place is longer, the arc is none, whatever its radii say.
constexpr double kMostShift_mm = 0.5;
/// The appliance takes ends that are so near for one place.
constexpr double kClosed_mm = 1e-3;
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

}  // namespace

bool closes(const Point& start, const Point& end, const Point& centre, const Plane& plane, bool counter_clockwise) {
  const Chord chord = chord_of(start, end, plane), spoke = chord_of(centre, start, plane);
  if (chord.length > kClosed_mm) return false;
  if (chord.length <= kFullCircle_rad * spoke.length) return true;
  const double ahead =
      spoke.first * chord.second - spoke.second * chord.first;  // positive: the end is counter-clockwise of the start
  return (ahead > 0) != counter_clockwise;
}

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

Point evened_centre(const Point& start, const Point& end, const Point& centre, const Plane& plane, std::size_t place) {
  const double to_start = distance(start, centre, plane), to_end = distance(end, centre, plane);
  if (to_start <= kClosed_mm) refuse(place, "the arc's centre is where it begins");
  const double off = std::abs(to_start - to_end);
  if (off > kMostOff_mm || (off > kOff_mm && off > kRelative * to_start)) {
    refuse(place,
           fmt::format(
               "the arc's centre is {:.6g} mm from its start and {:.6g} mm from its end; correct I, J, K or the end",
               to_start, to_end));
  }
  const Chord chord = chord_of(start, end, plane);
  if (chord.length <= kClosed_mm) return centre;
  const double along = ((centre.at(plane.first) - start.at(plane.first)) * chord.first +
                        (centre.at(plane.second) - start.at(plane.second)) * chord.second) /
                       chord.length;
  const double shift = chord.length / 2 - along;
  if (std::abs(shift) > kMostShift_mm) {
    refuse(
        place,
        fmt::format(
            "an arc that nearly closes, with radii {:.6g} mm apart, tells no circle; correct I, J, K or the end", off));
  }
  Point even = centre;
  even.at(plane.first) += shift * chord.first / chord.length;
  even.at(plane.second) += shift * chord.second / chord.length;
  return even;
}

}  // namespace rmac::rs274
