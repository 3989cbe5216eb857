#include "clients/legacy/gcode/mover.hpp"

#include <cmath>

namespace rmac::gcode {

void Mover::write_frame() {
  const auto origin = coordinates_.part_origin();
  if (!origin || origin == frame_) return;
  writer_.part_frame(*origin);
  frame_ = origin;
}

void Mover::write_feed(double mm_min, std::size_t place) {
  if (!legacy::is_feed(mm_min)) refuse(place, "the feed is not within 0.01 and 1 000 000 mm/min");
  if (feed_mm_min_ != mm_min) writer_.feed(mm_min);
  feed_mm_min_ = mm_min;
}

void Mover::write_rapid(const Point& end, std::size_t place) {
  write_feed(options_.rapid_mm_min, place);
  writer_.rapid(coordinates_.placed(end));
  axis_here_ = axis_;
}

void Mover::aim(const Point& axis) {
  if (axis == axis_) return;
  axis_ = axis;
  writer_.tool_axis(axis);
}

void Mover::turn(const Point& axis, std::size_t place) {
  aim(axis);
  if (coordinates_.tip_is_known()) go(coordinates_.known_tip(), place);
}

Point Mover::start(std::size_t place) {
  if (!coordinates_.tip_is_known()) {
    if (!options_.approach_mm) {
      refuse(place,
             "where the tool is before this move is not known; begin, and go on after a tool change or another work "
             "system, "
             "with a G0 to X, Y and Z, or give --approach X,Y,Z");
    }
    write_frame();
    const Point approach = coordinates_.unplaced(*options_.approach_mm);
    write_rapid(approach, place);
    coordinates_.move_to(approach);
  }
  return coordinates_.known_tip();
}

void Mover::require_reach(const Point& point, std::size_t place) const {
  for (const double value : coordinates_.placed(point)) {
    if (!(std::abs(value) <= legacy::kFarthest_mm)) refuse(place, "a move beyond 1 000 000 mm");
  }
}

void Mover::prepare(const Point& end, std::size_t place) {
  require_reach(end, place);
  if (modes_.length == ToolLength::Off && !options_.assume_g43 && coordinates_.tip()[2] != end[2]) {
    refuse(place,
           "Z of a tool whose length does not count (G49, or M6 without G43 behind it): the appliance's Z is always "
           "the tip's; "
           "write G43 before this move, or give --assume-g43");
  }
  write_frame();
}

void Mover::rapid(const Point& end, std::size_t place) {
  prepare(end, place);
  go(end, place);
}

void Mover::reference(const Point& end, std::size_t place) {
  require_reach(end, place);
  write_frame();
  go(end, place);
}

void Mover::go(const Point& end, std::size_t place) {
  if (!coordinates_.tip_is_known() || coordinates_.known_tip() != end || axis_ != axis_here_) write_rapid(end, place);
  coordinates_.move_to(end);
}

void Mover::prepare_feed(const Point& end, double feed_mm_min, std::size_t place) {
  const Point from = start(place);
  prepare(end, place);
  if (feed_mm_min == 0) refuse(place, "no feed was set before this move; write F");
  write_feed(feed_mm_min, place);
  writer_.begin(coordinates_.placed(from));
}

void Mover::line(const Point& end, double feed_mm_min, std::size_t place) {
  prepare_feed(end, feed_mm_min, place);
  writer_.line(coordinates_.placed(end));
  axis_here_ = axis_;
  coordinates_.move_to(end);
}

void Mover::arc(const Arc& arc, double feed_mm_min, std::size_t place) {
  prepare_feed(arc.end, feed_mm_min, place);
  writer_.arc(placed(arc));
  axis_here_ = axis_;
  coordinates_.move_to(arc.end);
}

Arc Mover::placed(const Arc& arc) const {
  const auto& placement = coordinates_.placement();
  if (!placement) return arc;
  Arc there = arc;
  there.centre = placement->placed(arc.centre);
  there.end = placement->placed(arc.end);
  there.axis = placement->turned(arc.axis);
  if (placement->mirrors()) there.counter_clockwise = !arc.counter_clockwise;
  return there;
}

void Mover::held(const ContourMove& move, std::size_t place) {
  const std::size_t line_now = writer_.line();
  writer_.at_line(move.line);
  if (move.rapid) {
    rapid(move.end, place);
  } else if (move.arc) {
    arc(*move.arc, move.feed_mm_min, place);
  } else {
    line(move.end, move.feed_mm_min, place);
  }
  writer_.at_line(line_now);
}

void Mover::nurbs(const legacy::Nurbs& curve, std::size_t place) {
  for (const Point& point : curve.points) require_reach(point, place);
  prepare_feed(curve.points.back(), modes_.feed_mm_min, place);
  if (!coordinates_.placement()) {
    writer_.nurbs(curve);
  } else {
    legacy::Nurbs there = curve;
    for (Point& point : there.points) point = coordinates_.placed(point);
    writer_.nurbs(there);
  }
  coordinates_.move_to(curve.points.back());
}

}  // namespace rmac::gcode
