#include "clients/legacy/gcode/radius/compensation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "clients/legacy/gcode/blocks/refusal.hpp"
#include "clients/legacy/program/arc_geometry.hpp"

namespace rmac::gcode {

using legacy::Arc, legacy::Point;

namespace {

/// Moves that turn by less are tangent but for rounding, as in LinuxCNC: of the radius the tool comes 0.00005 too near
/// at most. A reversal may be off by as much.
constexpr double kStraight_rad = 0.01;
/// Ways that rounding left between two moves are gone where they are longer: arcs are to begin on their circles.
constexpr double kGap_mm = 1e-5;
/// An arc around a corner that is shorter is a line.
constexpr double kShort_mm = 1e-3;

Flat flat(const Point& point) {
  return {point[0], point[1]};
}

double sweep_of(const Point& start, const Arc& arc) {
  const double from = std::atan2(start[1] - arc.centre[1], start[0] - arc.centre[0]);
  const double to = std::atan2(arc.end[1] - arc.centre[1], arc.end[0] - arc.centre[0]);
  double sweep = std::fmod(arc.counter_clockwise ? to - from : from - to, legacy::kTurn_rad);
  if (sweep < 0) sweep += legacy::kTurn_rad;
  return (arc.closed ? legacy::kTurn_rad : sweep) + legacy::kTurn_rad * arc.more_turns;
}

/// How far left the second direction turns from the first: from -pi to pi.
double turn_of(const Flat& first, const Flat& second) {
  return std::atan2(first.x * second.y - first.y * second.x, first.x * second.x + first.y * second.y);
}

}  // namespace

void Compensation::begin(double left_mm, const Point& at) {
  state_ = State::On;
  left_mm_ = left_mm;
  programmed_ = tool_ = at;
  held_.reset();
  depths_.clear();
}

void Compensation::end(std::size_t place) {
  if (!on()) return;
  if (held_) give_out(held_->to, place);
  state_ = held_ ? State::Leaving : State::Off;
}

void Compensation::move(const ContourMove& move, std::size_t place) {
  const bool in_plane = move.arc || move.end[0] != programmed_[0] || move.end[1] != programmed_[1];
  if (!held_) {
    enter(move, place);
  } else if (in_plane) {
    const Offset behind = offset_of(move, place);
    turn_corner(behind, move, place);
  } else {
    depths_.push_back(move);
  }
  programmed_ = move.end;
}

void Compensation::enter(const ContourMove& move, std::size_t place) {
  if (move.arc) refuse(place, "the first move of G41 and G42 is a straight one; write a line before this arc");
  const double way = std::hypot(move.end[0] - programmed_[0], move.end[1] - programmed_[1]);
  if (way <= std::abs(left_mm_))
    refuse(place,
           fmt::format("the first move of G41 and G42 has to be longer in X and Y than the tool's radius, {:.6g} mm",
                       std::abs(left_mm_)));
  const Offset offset = offset_of(move, place);
  held_ = Held{move, offset, 0, offset.length(), true};
}

Offset Compensation::offset_of(const ContourMove& move, std::size_t place) const {
  if (!move.arc) return Offset::of_line(flat(programmed_), flat(move.end), left_mm_);
  const auto offset = Offset::of_arc(flat(programmed_), flat(move.arc->centre), move.arc->counter_clockwise,
                                     sweep_of(programmed_, *move.arc), left_mm_);
  if (!offset)
    refuse(place, fmt::format("the tool, of radius {:.6g} mm, does not get into this arc; take a smaller one",
                              std::abs(left_mm_)));
  return *offset;
}

void Compensation::turn_corner(const Offset& behind, const ContourMove& move, std::size_t place) {
  const double left_turn = turn_of(held_->offset.last_direction(), behind.first_direction());
  const double away = left_mm_ > 0 ? -left_turn : left_turn;  // from the tool's side
  if (std::abs(away) <= kStraight_rad || left_mm_ == 0) {
    give_out(held_->to, place);
    const double from = behind.near_begin(flat(tool_));
    if (move.arc) step_to(behind.at(from), move, place);
    const bool is_whole = move.arc && move.arc->closed;  // it ends where it begins
    held_ = Held{move, behind, from, behind.length() + (is_whole ? from : 0)};
  } else if (away > 0 || away < -std::numbers::pi + kStraight_rad) {
    go_around(behind, move, std::abs(away), place);
    held_ = Held{move, behind, 0, behind.length()};
  } else if (held_->is_first && enters_to_normal_) {
    const Flat to = behind.at(0);
    ContourMove first = held_->move;
    first.end = {to.x, to.y, first.end[2]};
    sink_(first, place);
    tool_ = first.end;
    give_out_depths(place);
    held_ = Held{move, behind, 0, behind.length()};
  } else {
    // The first move may end where the next one begins to be cut, even behind its own begin, if the tool is clear
    // there.
    if (held_->is_first && behind.has_beside(flat(tool_), left_mm_)) held_->from = -legacy::kFarthest_mm;
    const auto corner = Offset::meet(held_->offset, held_->from, behind);
    if (!corner)
      refuse(place, fmt::format("the tool, of radius {:.6g} mm, does not get into the corner between line {} and this; "
                                "take a smaller one",
                                std::abs(left_mm_), held_->move.line));
    give_out(corner->on_first, place);
    held_ = Held{move, behind, corner->on_second, behind.length()};
  }
}

/// An outside corner: about it, at the depth and the feed of the move behind it.
void Compensation::go_around(const Offset& behind, const ContourMove& move, double turn_rad, std::size_t place) {
  const Flat direction = held_->offset.last_direction();
  give_out(held_->to, place);
  step_to({programmed_[0] - direction.y * left_mm_, programmed_[1] + direction.x * left_mm_}, move, place);
  const Flat to = behind.at(0);
  ContourMove around = move;
  around.arc.reset();
  around.end = {to.x, to.y, tool_[2]};
  if (!move.rapid && turn_rad * std::abs(left_mm_) > kShort_mm) {
    around.arc =
        Arc{.centre = {programmed_[0], programmed_[1], tool_[2]}, .end = around.end, .counter_clockwise = left_mm_ < 0};
  }
  sink_(around, place);
  tool_ = around.end;
}

void Compensation::step_to(const Flat& to, const ContourMove& move, std::size_t place) {
  if (std::hypot(to.x - tool_[0], to.y - tool_[1]) <= kGap_mm) return;
  ContourMove step = move;
  step.arc.reset();
  step.end = {to.x, to.y, tool_[2]};
  sink_(step, place);
  tool_ = step.end;
}

/// The move that is held, to this place of it, and the depths behind it.
void Compensation::give_out(double to, std::size_t place) {
  Held& held = *held_;
  if (to < held.from - held.offset.tolerance())
    refuse(place, fmt::format("the tool, of radius {:.6g} mm, does not get between the corners of the move in line {}; "
                              "take a smaller one",
                              std::abs(left_mm_), held.move.line));
  const Flat end = held.offset.at(to);
  ContourMove given = held.move;
  given.end = {end.x, end.y, held.move.end[2]};
  const double sweep = std::max(to - held.from, 0.0);
  if (sweep < held.offset.tolerance()) given.arc.reset();
  if (given.arc) {
    const double turns = std::floor((sweep + held.offset.tolerance()) / legacy::kTurn_rad);
    given.arc->closed = sweep - turns * legacy::kTurn_rad < held.offset.tolerance();
    given.arc->more_turns = static_cast<int>(turns) - (given.arc->closed ? 1 : 0);
    given.arc->centre[2] = tool_[2];
    if (given.arc->closed) given.end = {tool_[0], tool_[1], held.move.end[2]};
    given.arc->end = given.end;
  }
  sink_(given, place);
  tool_ = given.end;
  give_out_depths(place);
}

void Compensation::give_out_depths(std::size_t place) {
  for (ContourMove& depth : depths_) {
    depth.end = {tool_[0], tool_[1], depth.end[2]};
    sink_(depth, place);
    tool_ = depth.end;
  }
  depths_.clear();
}

}  // namespace rmac::gcode
