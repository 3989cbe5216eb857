#include "clients/legacy/gcode/radius/offset.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clients/legacy/program/arc_geometry.hpp"
namespace rmac::gcode {

namespace {

Flat between(const Flat& from, const Flat& to) {
  return {to.x - from.x, to.y - from.y};
}

Flat moved(const Flat& from, const Flat& along, double by) {
  return {from.x + along.x * by, from.y + along.y * by};
}

double dot(const Flat& a, const Flat& b) {
  return a.x * b.x + a.y * b.y;
}

double cross(const Flat& a, const Flat& b) {
  return a.x * b.y - a.y * b.x;
}

double length_of(const Flat& way) {
  return std::hypot(way.x, way.y);
}

Flat left_of(const Flat& direction) {
  return {-direction.y, direction.x};
}

/// The square root of what rounding may have made less than nothing.
double root(double square, double scale) {
  return square > -1e-12 * scale * scale ? std::sqrt(std::max(square, 0.0)) : -1;
}

}  // namespace

Offset Offset::of_line(const Flat& begin, const Flat& end, double left_mm) {
  Offset offset;
  const Flat way = between(begin, end);
  offset.length_ = length_of(way);
  offset.along_ = {way.x / offset.length_, way.y / offset.length_};
  offset.begin_ = moved(begin, left_of(offset.along_), left_mm);
  return offset;
}

std::optional<Offset> Offset::of_arc(const Flat& begin, const Flat& centre, bool counter_clockwise, double sweep_rad,
                                     double left_mm) {
  Offset offset;
  const Flat spoke = between(centre, begin);
  offset.is_arc_ = true;
  offset.left_turn_ = counter_clockwise;
  offset.centre_ = centre;
  offset.radius_ = length_of(spoke) - (counter_clockwise ? left_mm : -left_mm);  // the centre is on the turn's side
  offset.angle_ = std::atan2(spoke.y, spoke.x);
  offset.length_ = sweep_rad;
  return offset.radius_ > kSame_mm ? std::optional(offset) : std::nullopt;
}

Flat Offset::at(double place) const {
  if (!is_arc_) return moved(begin_, along_, place);
  const double angle_there = angle(place);
  return moved(centre_, {std::cos(angle_there), std::sin(angle_there)}, radius_);
}

Flat Offset::direction(double place) const {
  if (!is_arc_) return along_;
  const double angle_there = angle(place);
  const Flat left = left_of({std::cos(angle_there), std::sin(angle_there)});
  return left_turn_ ? left : Flat{-left.x, -left.y};
}

double Offset::measure(const Flat& place, bool last) const {
  if (!is_arc_) return dot(between(begin_, place), along_);
  const Flat spoke = between(centre_, place);
  const double turned = std::atan2(spoke.y, spoke.x) - angle_;
  double result = std::fmod(left_turn_ ? turned : -turned, legacy::kTurn_rad);
  if (result < -tolerance()) result += legacy::kTurn_rad;
  if (result > legacy::kTurn_rad - tolerance()) result -= legacy::kTurn_rad;
  if (last)
    result += legacy::kTurn_rad * std::max(std::floor((length_ + tolerance() - result) / legacy::kTurn_rad), 0.0);
  return result;
}

double Offset::near_begin(const Flat& place) const {
  const double result = measure(place, false);
  return is_arc_ && result > std::numbers::pi ? result - legacy::kTurn_rad : result;
}

bool Offset::has_beside(const Flat& place, double left_mm) const {
  const double left = cross(along_, between(begin_, place));
  return !is_arc_ && (left_mm > 0 ? left : -left) >= -kSame_mm;
}

std::optional<Offset::Meeting> Offset::meet(const Offset& first, double from, const Offset& second) {
  std::optional<Meeting> result;
  for (const Flat& place : crossings(first, second)) {
    const Meeting there{first.measure(place, true), second.measure(place, false)};
    const bool on_first =
        there.on_first >= from - first.tolerance() && there.on_first <= first.length() + first.tolerance();
    const bool on_second =
        there.on_second >= -second.tolerance() && there.on_second <= second.length() + second.tolerance();
    if (on_first && on_second && (!result || there.on_first > result->on_first)) result = there;
  }
  return result;
}

std::vector<Flat> Offset::crossings(const Offset& one, const Offset& other) {
  if (one.is_arc_ && other.is_arc_) return crossings_of_circles(one, other);
  if (one.is_arc_) return crossings_of_line(other, one);
  return other.is_arc_ ? crossings_of_line(one, other) : crossings_of_lines(one, other);
}

std::vector<Flat> Offset::crossings_of_lines(const Offset& one, const Offset& other) {
  const double turn = cross(one.along_, other.along_);
  if (turn == 0) return {};
  return {moved(one.begin_, one.along_, cross(between(one.begin_, other.begin_), other.along_) / turn)};
}

std::vector<Flat> Offset::crossings_of_line(const Offset& line, const Offset& circle) {
  const Flat foot = moved(line.begin_, line.along_, dot(between(line.begin_, circle.centre_), line.along_));
  const double off = length_of(between(foot, circle.centre_));
  const double half = root(circle.radius_ * circle.radius_ - off * off, circle.radius_);
  if (half < 0) return {};
  return {moved(foot, line.along_, half), moved(foot, line.along_, -half)};
}

std::vector<Flat> Offset::crossings_of_circles(const Offset& one, const Offset& other) {
  const Flat way = between(one.centre_, other.centre_);
  const double apart = length_of(way);
  if (apart == 0) return {};
  const Flat along{way.x / apart, way.y / apart};
  const double to_chord = (apart * apart + one.radius_ * one.radius_ - other.radius_ * other.radius_) / (2 * apart);
  const double half = root(one.radius_ * one.radius_ - to_chord * to_chord, one.radius_);
  if (half < 0) return {};
  const Flat middle = moved(one.centre_, along, to_chord);
  return {moved(middle, left_of(along), half), moved(middle, left_of(along), -half)};
}

}  // namespace rmac::gcode
