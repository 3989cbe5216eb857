#pragma once

#include <cstddef>

#include "clients/legacy/program/writer.hpp"

namespace rmac::rs274 {

using legacy::Arc, legacy::Point, legacy::Writer;

/// The plane of arcs and the axis along which holes are drilled: G17 is {0, 1, 2}, G18 {2, 0, 1}, G19 {1, 2, 0}, so
/// that counter-clockwise turns the first axis towards the second.
struct Plane {
  std::size_t first = 0, second = 1, normal = 2;
};

/// Radius format: the centre of an arc of this radius (negative: the longer way). Throws a Refusal at `place` where
/// there is none. The normal coordinate is the start's.
[[nodiscard]] Point centre_by_radius(const Point& start, const Point& end, const Plane& plane, bool counter_clockwise,
                                     double radius, std::size_t place);

/// Centre format: the centre that is as far from the start as from the end. Programs round, so what was written is off
/// by a little; by more than rs274 allows it is refused.
[[nodiscard]] Point evened_centre(const Point& start, const Point& end, const Point& centre, const Plane& plane,
                                  std::size_t place);

/// Whether the arc is a full turn, seen along the plane's normal: its end is its start, or lies so near behind it that
/// the appliance could not tell.
[[nodiscard]] bool closes(const Point& start, const Point& end, const Point& centre, const Plane& plane,
                          bool counter_clockwise);

}  // namespace rmac::rs274
