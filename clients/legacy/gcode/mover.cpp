#include "clients/legacy/gcode/mover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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
  if (std::exchange(by_joints_, false)) {
    writer_.rapid_of_joints(coordinates_.placed(end));
  } else {
    writer_.rapid(coordinates_.placed(end));
  }
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
    const auto& placement = coordinates_.placement();
    const Point approach = placement ? placement->back().placed(*options_.approach_mm) : *options_.approach_mm;
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
  if (turn_) return turn_along(end, true, place);
  go(end, place);
}

void Mover::reference(const Point& end, std::size_t place) {
  require_reach(end, place);
  write_frame();
  go(end, place);
}

void Mover::go(const Point& end, std::size_t place) {
  const bool stays = coordinates_.tip_is_known() && coordinates_.known_tip() == end && axis_ == axis_here_;
  if (!stays || by_joints_) write_rapid(end, place);
  coordinates_.move_to(end);
}

void Mover::prepare_feed(const Point& end, double feed_mm_min, std::size_t place) {
  const Point from = start(place);
  prepare(end, place);
  if (feed_mm_min == 0) refuse(place, "no feed was set before this move; write F");
  write_feed(feed_mm_min, place);
  writer_.begin(coordinates_.placed(from));
}

void Mover::line(const Point& end, std::size_t place) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  double way = legacy::length(legacy::difference(end, start(place)));
  if (way == 0)
    way = kDegrees * std::atan2(legacy::length(legacy::cross(axis_here_, axis_)), legacy::dot(axis_here_, axis_));
  line(end, turn_ ? 0 : modes_.feed_over(way, place), place);
}

void Mover::line(const Point& end, double feed_mm_min, std::size_t place) {
  if (turn_) {
    prepare(end, place);
    return turn_along(end, false, place);
  }
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
  const auto placement = coordinates_.whole();
  if (!placement) return arc;
  Arc there = arc;
  there.centre = placement->placed(arc.centre);
  there.end = placement->placed(arc.end);
  there.axis = placement->turned(arc.axis);
  if (placement->mirrors()) there.counter_clockwise = !arc.counter_clockwise;
  return there;
}

void Mover::turn_with_next(Table table, const TableAngles& begin, const TableAngles& end) {
  turn_ = Turn{std::move(table), begin, end};
}

void Mover::turn_unseen(const Point& axis) {
  aim(axis);
  by_joints_ = true;
}

void Mover::turn_along(const Point& end, bool rapid, std::size_t place) {
  const Turn turn = *std::exchange(turn_, std::nullopt);
  const Point from = coordinates_.known_tip();
  const TableMove move{coordinates_.beside_table(from), coordinates_.beside_table(end), turn.begin, turn.end};
  const TurnedWay way = turned_way(turn.table, move);
  const legacy::Placement table = placement_of(turn.table, turn.end);
  writer_.begin(coordinates_.placed(from));
  if (!rapid && way.rests_askew)
    refuse(place,
           "the tip stands on the axis of the table, and the tool, which is tilted to it, would go round a cone: have "
           "the post write this turn as G0");
  if (rapid && way.rests_askew) {
    coordinates_.turn(table);
    turn_unseen(table.z);
    return go(end, place);
  }
  const double turns_or_mm = way.length_mm > 0 ? way.length_mm : way.turn_degrees;
  // Where little of the block counts for F, axes that are as fast as they can be bound it on the program's machine.
  const double feed =
      rapid ? options_.rapid_mm_min : turns_or_mm / minutes_of(move, way, {options_, rules_, modes_}, place);
  if (!legacy::is_feed(feed) && feed < 1 && (modes_.inverse_time || legacy::is_feed(modes_.feed_mm_min)))
    refuse(
        place,
        "the tip hardly moves while the table turns, and no feed says how slowly; have the post write this turn as G0");
  write_feed(std::min(feed, options_.rapid_mm_min), place);
  write(way, writer_);
  coordinates_.turn(table);
  axis_ = axis_here_ = table.z;
  writer_.tool_axis(axis_);
  coordinates_.move_to(end);
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
  if (!coordinates_.whole()) {
    writer_.nurbs(curve);
  } else {
    legacy::Nurbs there = curve;
    for (Point& point : there.points) point = coordinates_.placed(point);
    writer_.nurbs(there);
  }
  coordinates_.move_to(curve.points.back());
}

}  // namespace rmac::gcode
