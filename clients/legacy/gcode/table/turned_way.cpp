#include "clients/legacy/gcode/table/turned_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace rmac::gcode {

namespace {

using legacy::along, legacy::difference, legacy::dot, legacy::Point, legacy::PoseSpline;

constexpr double kRadians = std::numbers::pi / 180;
/// Smaller arcs are none to the appliance; and what four decimals of an inch round in two coordinates, 1.8 um, is less.
constexpr double kLeastOfArc_mm = 2e-3;

double way_of(const TableMove& move, const TableAxis& axis) {
  return move.end.at(axis.angle) - move.begin.at(axis.angle);
}

/// How far the share is from `from` to `to` on the way of the tip: Gauss and Legendre, five places.
double length_between(const Table& table, const TableMove& move, double from, double to) {
  constexpr std::array<double, 3> kPlaces{0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> kWeights{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double sum = kWeights[0] * legacy::length(tip_at(table, move, middle).first);
  for (std::size_t i = 1; i < kPlaces.size(); ++i) {
    for (const double side : {-1.0, 1.0})
      sum += kWeights.at(i) * legacy::length(tip_at(table, move, middle + side * half * kPlaces.at(i)).first);
  }
  return half * sum;
}

/// The one axis that turns, and what it sees of the move.
struct OneAxis {
  const TableAxis* axis = nullptr;
  Table outside;              ///< what carries the axis' own turn to the part
  Point from{}, to{};         ///< of the tip, relative to the axis' centre
  double radius_mm = 0;       ///< of the begin
  bool turns_evenly = false;  ///< the tool's axis, in one plane, or not at all

  [[nodiscard]] double radius(const Point& arm) const {
    return std::hypot(arm.at(axis->plane.first), arm.at(axis->plane.second));
  }
};

std::optional<OneAxis> one_axis(const Table& table, const TableMove& move) {
  const auto turns = [&move](const TableAxis& axis) { return way_of(move, axis) != 0; };
  if (std::ranges::count_if(table, turns) != 1) return std::nullopt;
  const auto found = std::ranges::find_if(table, turns);
  OneAxis one;
  one.axis = &*found;
  one.outside.assign(table.begin(), found);
  const auto inside = placement_of(Table(found + 1, table.end()), move.begin);
  one.from = difference(inside.placed(move.from), found->centre);
  one.to = difference(inside.placed(move.to), found->centre);
  one.radius_mm = one.radius(one.from);
  constexpr double kAlong = 1e-9;
  one.turns_evenly = std::abs(inside.z.at(found->plane.normal)) <= kAlong || one.radius(inside.z) <= kAlong;
  return one;
}

/// Whether the tip keeps its place in the plane that turns.
bool keeps_distance(const OneAxis& one) {
  constexpr double kSame_mm = 1e-7;
  return one.radius(difference(one.to, one.from)) <= kSame_mm;
}

/// Its axis turns by less than half a turn in each piece, which is how far a direction is told by its ends.
template <typename Add>
void cut(double degrees, const Add& add) {
  constexpr double kMostOfPiece = 120;
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(degrees) / kMostOfPiece)));
  for (int piece = 1; piece <= pieces; ++piece) add(piece == pieces ? 1.0 : static_cast<double>(piece) / pieces);
}

/// A tip beside the axis by what digits round rests in the plane that turns, and goes to its end at the end: next to
/// nothing would else be its way while the table turns.
TurnedWay along_axis(const Table& table, const TableMove& move, const OneAxis& one) {
  constexpr double kStep_mm = 5e-4;  // the appliance tells that from rest
  const std::size_t normal = one.axis->plane.normal;
  const double climb = one.to.at(normal) - one.from.at(normal);
  const Point begin = tip_at(table, move, 0).at;
  const Point climbed = placement_of(one.outside, move.begin).turned(legacy::scaled(climb, legacy::unit_axis(normal)));
  const TurnedLine end{tip_at(table, move, 1).at, axis_at(table, move, 1).at};
  const bool steps = legacy::length(difference(end.end, along(begin, 1, climbed))) > kStep_mm;
  TurnedWay way;
  way.length_mm = std::abs(climb);
  cut(way_of(move, *one.axis), [&](double share) {
    const bool is_end = share == 1 && !steps;
    way.pieces.emplace_back(is_end ? end : TurnedLine{along(begin, share, climbed), axis_at(table, move, share).at});
  });
  if (steps) way.pieces.emplace_back(end);
  return way;
}

TurnedWay straight(const Table& table, const TableMove& move, double length_mm) {
  TurnedWay way;
  way.length_mm = length_mm;
  way.pieces.emplace_back(TurnedLine{tip_at(table, move, 1).at, axis_at(table, move, 1).at});
  return way;
}

TurnedWay about_axis(const Table& table, const TableMove& move, const OneAxis& one) {
  const std::size_t normal = one.axis->plane.normal;
  const auto outside = placement_of(one.outside, move.begin);
  const double degrees = one.axis->sign * way_of(move, *one.axis);
  const double climb = one.to.at(normal) - one.from.at(normal);
  const double round_mm = one.radius_mm * std::abs(degrees) * kRadians;
  if (round_mm <= kLeastOfArc_mm) return straight(table, move, std::hypot(round_mm, climb));
  double share_before = 0;
  TurnedWay way;
  way.length_mm = std::hypot(round_mm, climb);
  cut(degrees, [&](double share) {
    Point centre = one.axis->centre;
    centre.at(normal) += one.from.at(normal) + share_before * climb;
    legacy::Arc arc{.centre = outside.placed(centre),
                    .end = tip_at(table, move, share).at,
                    .axis = outside.turned(legacy::unit_axis(normal)),
                    .counter_clockwise = degrees > 0};
    way.pieces.emplace_back(TurnedArc{arc, axis_at(table, move, share).at});
    share_before = share;
  });
  return way;
}

/// Into how many pieces of degree 5 the way is cut, so that the rest of Hermite's interpolation (the sixth derivative,
/// by the length's sixth power, over 6! * 2^6) is within the tolerance.
int spline_pieces(const Table& table, const TableMove& move) {
  double radians = 0, reach = 0;
  Point before{};
  for (const TableAxis& axis : table) {
    radians += std::abs(way_of(move, axis)) * kRadians;
    reach += legacy::length(difference(axis.centre, before));
    before = axis.centre;
  }
  reach = std::max({reach, 1.0, legacy::length(difference(move.from, before)) + reach,
                    legacy::length(difference(move.to, before)) + reach});
  const double speed = legacy::length(difference(move.to, move.from));
  const double sixth = std::pow(radians, 5) * (radians * reach + 6 * speed);
  constexpr double kFactor = 46080, kMostOfPiece_rad = 0.5;
  const double pieces =
      std::max(std::pow(sixth / (kFactor * kSplineTolerance_mm), 1.0 / 6), radians / kMostOfPiece_rad);
  return std::max(1, static_cast<int>(std::ceil(pieces)));
}

PoseSpline::Pose pose(const Point& tip, const Point& axis) {
  return {tip[0], tip[1], tip[2], axis[0], axis[1], axis[2]};
}

/// Control points of one piece, by value and two derivatives at both ends.
std::array<Point, 6> control_points(const Jet& begin, const Jet& end, double width) {
  const double first = width / 5, second = width * width / 20;
  return {begin.at,
          along(begin.at, first, begin.first),
          along(along(begin.at, 2 * first, begin.first), second, begin.second),
          along(along(end.at, -2 * first, end.first), second, end.second),
          along(end.at, -first, end.first),
          end.at};
}

/// Appends a piece: an inner knot is threefold, so that of the two points beside it their common blossom is left.
void append(PoseSpline& spline, const std::array<Point, 6>& tip, const std::array<Point, 6>& axis) {
  auto& points = spline.points;
  const auto at = [&](std::size_t i) { return pose(tip.at(i), axis.at(i)); };
  if (points.empty()) {
    points = {at(0), at(1), at(2), at(3), at(4), at(5)};
  } else {
    const auto fourth = points.at(points.size() - 2), third = points.at(points.size() - 3);
    points.resize(points.size() - 2);
    PoseSpline::Pose middle{};
    for (std::size_t i = 0; i < middle.size(); ++i) middle.at(i) = 2 * fourth.at(i) - third.at(i);
    points.insert(points.end(), {middle, at(2), at(3), at(4), at(5)});
  }
  ++spline.pieces;
}

TurnedWay by_splines(const Table& table, const TableMove& move) {
  constexpr int kMostPieces = 32;  // of one request
  const int pieces = spline_pieces(table, move);
  TurnedWay way;
  PoseSpline spline;
  Jet tip = tip_at(table, move, 0), axis = axis_at(table, move, 0);
  double before = 0;
  for (int piece = 1; piece <= pieces; ++piece) {
    const double share = piece == pieces ? 1.0 : static_cast<double>(piece) / pieces, width = share - before;
    const Jet tip_there = tip_at(table, move, share), axis_there = axis_at(table, move, share);
    append(spline, control_points(tip, tip_there, width), control_points(axis, axis_there, width));
    way.length_mm += length_between(table, move, before, share);
    if (spline.pieces == kMostPieces || piece == pieces) way.pieces.emplace_back(std::exchange(spline, {}));
    tip = tip_there;
    axis = axis_there;
    before = share;
  }
  return way;
}

}  // namespace

TurnedWay turned_way(const Table& table, const TableMove& move) {
  constexpr double kSpeck_degrees = 0.05;  // within 1e-7 its axis turns in one plane, whichever axes turn
  double squares = 0;
  for (const TableAxis& axis : table) squares += way_of(move, axis) * way_of(move, axis);
  const double turn_degrees = std::sqrt(squares);
  const auto one = one_axis(table, move);
  const bool evenly = one && one->turns_evenly;
  TurnedWay way;
  if (evenly && std::max(one->radius_mm, one->radius(one->to)) <= kLeastOfArc_mm) {
    way = along_axis(table, move, *one);
  } else if (evenly && keeps_distance(*one)) {
    way = about_axis(table, move, *one);
  } else {
    way = by_splines(table, move);
    const bool rests = way.length_mm <= kLeastOfArc_mm;
    if (rests && turn_degrees <= kSpeck_degrees) way = straight(table, move, way.length_mm);
    way.rests_askew = rests && turn_degrees > kSpeck_degrees;
  }
  way.turn_degrees = turn_degrees;
  return way;
}

}  // namespace rmac::gcode
