#pragma once

#include <cstddef>
#include <numbers>
#include <optional>

#include "clients/legacy/program/writer.hpp"

namespace rmac::legacy {

inline constexpr double kTurn_rad = 2 * std::numbers::pi;

/// The plane of arcs and the axis along which holes are drilled: G17 is {0, 1, 2}, G18 {2, 0, 1}, G19 {1, 2, 0}, so
/// that counter-clockwise turns the first axis towards the second.
struct Plane {
  std::size_t first = 0, second = 1, normal = 2;
};

/// Radius format: the centre of an arc of this radius (negative: the longer way). Throws a Refusal at `place` where
/// there is none. The normal coordinate is the start's.
[[nodiscard]] Point centre_by_radius(const Point& start, const Point& end, const Plane& plane, bool counter_clockwise,
                                     double radius, std::size_t place);

/// Of an arc or a helix about its centre.
[[nodiscard]] double length_of(const Point& start, const Arc& arc, const Plane& plane);

/// Centre format: the arc that is written for one whose radii differ, because programs round; by more than rs274 allows
/// it is refused. Its centre is moved to be evenly far from both ends where that keeps to the circle. Elsewhere the
/// arc keeps its centre and ends on its own circle, and a line to the end that was programmed is to follow; none where
/// the arc is so short that the line is all.
[[nodiscard]] std::optional<Arc> arc_about(const Point& start, const Arc& written, const Plane& plane,
                                           std::size_t place);

}  // namespace rmac::legacy
