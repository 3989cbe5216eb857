#pragma once

#include <cstddef>

#include "clients/legacy/apt/moves/mover.hpp"

namespace rmac::apt {

/// A circle in space, in coordinates of the part.
struct Circle {
  Point centre{}, axis = legacy::unit_axis(2);  ///< of unit length
  double radius_mm = 0;
};

/// Which way an arc goes about the circle's axis.
[[nodiscard]] inline bool is_counter_clockwise(const Circle& circle, const Point& start, const Point& forward) {
  return dot(cross(circle.axis, difference(start, circle.centre)), forward) > 0;
}

/// How far the arc turns from its start to the end, about the circle's axis: more than 0, at most a turn.
[[nodiscard]] double sweep_rad(const Circle& circle, const Point& start, const Point& end, bool counter_clockwise);

/// Whether two points lie nearer than the appliance tells arcs' ends apart, seen along the circle's axis.
[[nodiscard]] bool is_same_place(const Circle& circle, const Point& a, const Point& b);

/// Where an arc goes.
struct ArcCourse {
  Pose end;
  bool counter_clockwise = false;
  int more_turns = 0;
  double feed_mm_min = 0;
};

/// Writes the arc from where the tool is, which is known. Throws a Refusal at `place` where start, end and radius fit
/// no circle about the centre.
void move_along(const Circle& circle, const ArcCourse& course, Mover& mover, std::size_t place);

}  // namespace rmac::apt
