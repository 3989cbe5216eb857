#include "clients/legacy/apt/moves/arcs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "clients/legacy/program/arc_geometry.hpp"

namespace rmac::apt {

namespace {

constexpr int kMostTurns = 1001;
/// How far points that are to be one may be apart where programs round.
constexpr double kSamePoint_mm = 0.01;
/// A direction along an arc is less than a third of a right angle off it.
constexpr double kAlong = 0.86;
constexpr double kParallel = 0.9999;
/// CIRCLE of NX tells tolerances and the tool behind the radius.
constexpr std::size_t kNumbersOfNx = 11;

int turns_of_times(Arguments& arguments) {
  const int turns = arguments.integer("how often it goes round (TIMES)", kMostTurns);
  if (turns == 0) refuse(arguments.last_place(), "an arc of no turns");
  return turns;
}

/// Of a group of three numbers.
Point numbers_of(const Element& group) {
  Arguments arguments(group);
  const auto values = arguments.numbers({3}, "three numbers");
  arguments.end();
  return triple(values, 0);
}

}  // namespace

void Arcs::set_forward(Arguments& arguments) {
  forward_ = coordinates_.direction(triple(arguments.numbers({3}, "i,j,k"), 0), arguments.place());
  arguments.end();
}

void Arcs::set_surface(Arguments& arguments) {
  Arguments plane(arguments.group("PLANE"));
  arguments.end();
  Point normal{};
  if (plane.has_number()) {
    normal = triple(plane.numbers({4}, "a,b,c,d"), 0);
  } else {
    static_cast<void>(numbers_of(plane.group("POINT")));
    if (!plane.take("PERPTO")) refuse(plane.next_place(), "PSIS is taken as (PLANE/(POINT/…),PERPTO,(VECTOR/…))");
    normal = numbers_of(plane.group("VECTOR"));
  }
  plane.end();
  surface_ = coordinates_.direction(normal, plane.place());
}

/// Four numbers: about Z; seven, or NX's eleven: about an axis of its own.
Circle Arcs::circle_of(const std::vector<double>& values, std::size_t place) const {
  Circle circle;
  circle.centre = coordinates_.point(triple(values, 0), place);
  const bool has_axis = values.size() > 4;
  circle.axis = coordinates_.direction(has_axis ? triple(values, 3) : legacy::unit_axis(2), place);
  circle.radius_mm = coordinates_.mm(values.at(has_axis ? 6 : 3), place);
  if (!(circle.radius_mm > 0)) refuse(place, "a circle's radius is more than 0");
  return circle;
}

Circle Arcs::followed_circle(const Element& element) {
  Arguments curve(element);
  if (curve.major() == "CIRCLE") {
    static_cast<void>(curve.take("CANON"));
    const auto values = curve.numbers({4, 7}, "x,y,z[,i,j,k],r");
    curve.end();
    return circle_of(values, curve.place());
  }
  if (curve.major() != "CYLNDR")
    refuse(element.place,
           "the tool is driven along a (CIRCLE/…) or a (CYLNDR/…) only; have the CAM system write points");
  const auto values = curve.numbers({7}, "x,y,z,i,j,k,r");
  curve.end();
  const Circle circle = circle_of(values, curve.place());
  if (surface_ && std::abs(dot(*surface_, circle.axis)) < kParallel)
    refuse(element.place, "the plane of PSIS is not perpendicular to this cylinder");
  return circle;
}

/// Where the line from the centre, or the plane through it, tells that the arc ends.
Point Arcs::followed_end(const Element& element, const Circle& circle) const {
  Arguments limit(element);
  Point centre{}, end{};
  if (limit.major() == "LINE") {
    const auto values = limit.numbers({6}, "x,y,z,x,y,z");
    centre = triple(values, 0);
    end = triple(values, 3);
  } else if (limit.major() == "PLANE" && limit.take("PERPTO")) {
    Arguments plane(limit.group("PLANE"));
    static_cast<void>(numbers_of(plane.group("POINT")));
    if (!plane.take("PERPTO")) refuse(plane.next_place(), "PERPTO is missing here");
    static_cast<void>(numbers_of(plane.group("VECTOR")));
    plane.end();
    centre = numbers_of(limit.group("POINT"));
    end = numbers_of(limit.group("POINT"));
  } else {
    refuse(element.place, "an arc ends at a (LINE/…) from its centre, or at a (PLANE/PERPTO,…) through it");
  }
  limit.end();
  const Point from = difference(coordinates_.point(centre, element.place), circle.centre);
  if (length(along(from, -dot(from, circle.axis), circle.axis)) > kSamePoint_mm)
    refuse(element.place, "what the arc ends at does not begin at its centre");
  return coordinates_.point(end, element.place);
}

bool Arcs::direction_of(const Circle& circle, const Point& start, std::size_t place) const {
  const Point tangent = cross(circle.axis, difference(start, circle.centre));
  const double size = length(tangent);
  if (size > 0 && std::abs(dot(tangent, *forward_)) < kAlong * size)
    refuse(place, "INDIRV does not point along the arc; correct it, or where the tool is before");
  return is_counter_clockwise(circle, start, *forward_);
}

/// A line through the centre meets the circle at two places. Which of them the arc comes by first follows from its end.
void Arcs::require_meeting(int meeting, double sweep_rad, bool whole, const Circle& circle, std::size_t place) const {
  const double blur_rad = kSamePoint_mm / circle.radius_mm;
  const bool may_be_first = !whole && sweep_rad <= std::numbers::pi + blur_rad;
  const bool may_be_second = whole || sweep_rad >= std::numbers::pi - blur_rad;
  if (meeting == 1 ? may_be_first : meeting == 2 && may_be_second) return;
  refuse(place,
         fmt::format("the arc to the end of this line turns {:.6g} degrees, but does not end at its meeting number "
                     "{} with the line through the centre; correct the end, INDIRV, or the number before INTOF",
                     whole ? 360 : sweep_rad / legacy::kTurn_rad * 360, meeting));
}

void Arcs::follow(Arguments& arguments, double feed_mm_min) {
  const std::size_t place = arguments.place();
  if (record_) refuse(place, "a CIRCLE before this has no GOTO to its arc's end");
  if (!forward_) refuse(place, "no INDIRV tells which way the arc goes; write it before this");
  const Element& curve = arguments.any("(CIRCLE/…)");
  const Circle circle = followed_circle(curve);
  if (!arguments.take("ON")) refuse(arguments.next_place(), "an arc ends ON a line; PAST, TO and TANTO are not taken");
  int meeting = 1;
  if (arguments.has_number()) {
    meeting = arguments.integer("the number of meetings", 2);
    if (!arguments.take("INTOF")) refuse(arguments.next_place(), "INTOF is missing here");
  }
  const Element& limit = arguments.any("(LINE/…)");
  const Point end = followed_end(limit, circle);
  arguments.end();

  const Point axis = coordinates_.axis(place);
  const Point start = mover_.start(axis, place).tip;
  const double rise = dot(difference(end, start), circle.axis);
  if (std::abs(rise) > kSamePoint_mm)
    refuse(limit.place, fmt::format("the arc's end is {:.6g} mm off the plane of its start", rise));
  const bool counter_clockwise = direction_of(circle, start, place);
  const bool whole = is_same_place(circle, start, end);
  require_meeting(meeting, sweep_rad(circle, start, end, counter_clockwise), whole, circle, limit.place);
  forward_.reset();
  surface_.reset();
  const Pose pose{whole ? start : end, axis};
  move_along(circle, {pose, counter_clockwise, 0, feed_mm_min}, mover_, place);
}

void Arcs::set_circle(Arguments& arguments) {
  if (record_) refuse(arguments.place(), "the CIRCLE before this has no GOTO to its arc's end");
  static_cast<void>(arguments.take("CANON"));
  const auto values = arguments.numbers({4, 7, kNumbersOfNx}, "x,y,z[,i,j,k],r");
  Record record;
  record.circle = circle_of(values, arguments.place());
  record.place = arguments.place();
  if (values.size() == kNumbersOfNx) record.counter_clockwise = false;
  if (arguments.take("TIMES")) record.turns = turns_of_times(arguments);
  arguments.end();
  if (options_.circle_axis) record.counter_clockwise = options_.circle_axis == CircleAxis::CounterClockwise;
  record_ = record;
}

void Arcs::set_arc(Arguments& arguments) {
  if (record_) refuse(arguments.place(), "the CIRCLE before this has no GOTO to its arc's end");
  const auto values = arguments.numbers({7}, "x,y,z,i,j,k,r");
  if (!arguments.take("ANGLE"))
    refuse(arguments.next_place(), "MOVARC is taken with ANGLE and the degrees that it turns");
  const double angle = arguments.number("degrees");
  if (!(std::abs(angle) <= 360.0 * kMostTurns)) refuse(arguments.last_place(), "an arc of too many turns");
  arguments.end();
  record_ = Record{.circle = circle_of(values, arguments.place()),
                   .place = arguments.place(),
                   .counter_clockwise = angle > 0,
                   .turns = {},
                   .angle_rad = std::abs(angle) / 360 * legacy::kTurn_rad};
}

/// Whole turns more than the sweep to the arc's end.
int Arcs::turns_of(const Record& record, double sweep_rad, bool whole) {
  if (record.angle_rad) {
    constexpr double kBlur_rad = 0.01, kBlur_mm = 0.5;
    const double more = std::round((*record.angle_rad - sweep_rad) / legacy::kTurn_rad);
    const double off_rad = std::abs(*record.angle_rad - sweep_rad - more * legacy::kTurn_rad);
    if (more < 0 || (off_rad > kBlur_rad && off_rad * record.circle.radius_mm > kBlur_mm)) {
      refuse(record.place, fmt::format("the arc to the GOTO behind it turns {:.6g} degrees, not ANGLE",
                                       sweep_rad / legacy::kTurn_rad * 360));
    }
    return static_cast<int>(more);
  }
  if (whole && !record.turns) {
    refuse(record.place,
           "the arc ends where it begins: a full circle, or none? Write TIMES,1 behind it, or take it out");
  }
  if (!whole && record.turns.value_or(1) > 1) {
    refuse(
        record.place,
        "TIMES of an arc that does not end above or below its start: whether its last part counts is not known; have "
        "the CAM system write it as two");
  }
  return record.turns.value_or(1) - 1;
}

void Arcs::end_at(const Pose& end, double feed_mm_min, std::size_t place) {
  const Record record = *std::exchange(record_, std::nullopt);
  const Circle& circle = record.circle;
  const Point start = mover_.start(end.axis, place).tip;
  if (!record.counter_clockwise && !forward_) {
    refuse(record.place,
           "whether arcs go clockwise about the axis of CIRCLE is not known of this CAM system; give --circle-axis "
           "clockwise or counter-clockwise, or have it write INDIRV");
  }
  const bool counter_clockwise = forward_ ? direction_of(circle, start, record.place) : *record.counter_clockwise;
  forward_.reset();
  const bool whole = is_same_place(circle, start, end.tip);
  Pose pose = end;
  if (whole) pose.tip = along(start, dot(difference(end.tip, start), circle.axis), circle.axis);
  const double sweep = whole ? legacy::kTurn_rad : sweep_rad(circle, start, end.tip, counter_clockwise);
  move_along(circle, {pose, counter_clockwise, turns_of(record, sweep, whole), feed_mm_min}, mover_, place);
}

void Arcs::require_complete(std::size_t place) const {
  if (record_) refuse(place, "the CIRCLE before this has no GOTO to its arc's end");
  if (forward_) refuse(place, "INDIRV is taken before arcs only, and before this there was none behind it");
}

}  // namespace rmac::apt
