// The way of the tool about a part that a table turns, held against the turn of each of its places.
#include "clients/legacy/gcode/table/turned_way.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "clients/legacy/gcode/modes/turns.hpp"
#include "gateway/threads/sanitized.hpp"

namespace rmac::gcode {
namespace {

using legacy::along, legacy::cross, legacy::difference, legacy::dot, legacy::Point, legacy::PoseSpline;

struct Pose {
  Point tip, axis;
};

/// Where the table brings the tip, by Rodrigues' formula, one axis after the other from the tool to the part.
Pose expected(const Table& table, const TableMove& move, double share) {
  Pose pose{along(move.from, share, difference(move.to, move.from)), {0, 0, 1}};
  for (auto axis = table.rbegin(); axis != table.rend(); ++axis) {
    const double degrees = move.begin.at(axis->angle) * (1 - share) + move.end.at(axis->angle) * share;
    const double angle = axis->sign * degrees * std::numbers::pi / 180;
    const Point about = legacy::unit_axis(axis->plane.normal);
    const auto turned = [&](const Point& arm) {
      const Point across = cross(about, arm);
      return along(along(arm, std::sin(angle), across), 1 - std::cos(angle), cross(about, across));
    };
    pose = {along(turned(difference(pose.tip, axis->centre)), 1, axis->centre), turned(pose.axis)};
  }
  return pose;
}

/// De Boor's algorithm, at `at` pieces from the begin.
Pose value_of(const PoseSpline& spline, double at) {
  constexpr int kDegree = 5;
  std::vector<double> knots;
  for (int knot = 0; knot <= spline.pieces; ++knot)
    knots.insert(knots.end(), knot == 0 || knot == spline.pieces ? kDegree + 1U : 3U, knot);
  const int piece = std::min(static_cast<int>(at), spline.pieces - 1);
  const std::size_t span = kDegree + 3 * static_cast<std::size_t>(piece);
  std::array<PoseSpline::Pose, kDegree + 1> points{};
  for (std::size_t i = 0; i <= kDegree; ++i) points.at(i) = spline.points.at(span - kDegree + i);
  for (std::size_t level = 1; level <= kDegree; ++level) {
    for (std::size_t i = kDegree; i >= level; --i) {
      const double low = knots.at(span - kDegree + i), high = knots.at(span + 1 + i - level);
      const double share = (at - low) / (high - low);
      for (std::size_t c = 0; c < 6; ++c)
        points.at(i).at(c) = (1 - share) * points.at(i - 1).at(c) + share * points.at(i).at(c);
    }
  }
  const auto& [x, y, z, i, j, k] = points.back();
  return {{x, y, z}, {i, j, k}};
}

void expect_near(const Pose& found, const Pose& wanted, double tip_mm, double axis) {
  EXPECT_LE(legacy::length(difference(found.tip, wanted.tip)), tip_mm);
  EXPECT_LE(legacy::length(difference(found.axis, wanted.axis)), axis);
}

TableAxis axis_of(char letter, double sign, const Point& centre) {
  return {static_cast<std::size_t>(letter - 'A'), plane_of(letter), sign, centre};
}

TEST(TurnedWay, OfATipThatKeepsItsDistanceIsArcsAboutTheAxis) {
  const Table table{axis_of('A', -1, {5, 1, -2})};
  const TableMove move{{0, 4, 2}, {30, 4, 2}, {20, 0, 0}, {740, 0, 0}};
  const TurnedWay way = turned_way(table, move);
  ASSERT_EQ(way.pieces.size(), 6U);
  EXPECT_NEAR(way.length_mm, std::hypot(5 * 4 * std::numbers::pi, 30), 1e-9);
  EXPECT_EQ(way.turn_degrees, 720);
  for (std::size_t piece = 0; piece < way.pieces.size(); ++piece) {
    const auto& [arc, axis] = std::get<TurnedArc>(way.pieces.at(piece));
    expect_near({arc.end, axis}, expected(table, move, static_cast<double>(piece + 1) / 6), 1e-12, 1e-12);
    EXPECT_FALSE(arc.counter_clockwise) << "an axis that turns the other way";
    EXPECT_EQ(arc.axis, (Point{1, 0, 0}));
    EXPECT_EQ(arc.centre[1], 1);
    EXPECT_EQ(arc.centre[2], -2);
    EXPECT_NEAR(arc.centre[0], 5.0 * static_cast<double>(piece), 1e-12) << "a helix begins at its centre's height";
  }
}

TEST(TurnedWay, OfATipOnTheAxisIsStraight) {
  const Table table{axis_of('B', 1, {5, 1, -2})};
  const TurnedWay way = turned_way(table, {{5, 9, -2}, {5, 2, -2}, {0, 0, 0}, {0, -200, 0}});
  ASSERT_EQ(way.pieces.size(), 2U);
  EXPECT_EQ(way.length_mm, 7);
  EXPECT_EQ(std::get<TurnedLine>(way.pieces[0]).end, (Point{5, 5.5, -2}));
  EXPECT_NEAR(std::get<TurnedLine>(way.pieces[0]).axis[0], std::sin(-100 * std::numbers::pi / 180), 1e-12);
  EXPECT_EQ(std::get<TurnedLine>(way.pieces[1]).end, (Point{5, 2, -2}));
}

TEST(TurnedWay, OfOneAxisThatAnotherOneHasTiltedIsAnArcInThePlaneThatTurns) {
  const Table table{axis_of('C', 1, {0, 0, 0}), axis_of('A', 1, {0, 0, -50})};
  const TableMove move{{10, 0, -50}, {10, 0, -50}, {90, 0, 0}, {90, 0, 90}};
  const auto [arc, axis] = std::get<TurnedArc>(turned_way(table, move).pieces.at(0));
  expect_near({arc.end, axis}, expected(table, move, 1), 1e-12, 1e-12);
  EXPECT_EQ(arc.axis, (Point{0, 0, 1}));
  const TableMove tilts{{10, 7, -50}, {10, 7, -50}, {0, 0, 30}, {90, 0, 30}};
  const TurnedArc tilted = std::get<TurnedArc>(turned_way(table, tilts).pieces.at(0));
  expect_near({tilted.arc.end, tilted.axis}, expected(table, tilts, 1), 1e-12, 1e-12);
  EXPECT_NEAR(legacy::length(difference(tilted.arc.end, tilted.arc.centre)), 7, 1e-12);
  EXPECT_NEAR(dot(tilted.arc.axis, difference(tilted.arc.end, tilted.arc.centre)), 0, 1e-12);
}

TEST(TurnedWay, OfATiltedToolThatWouldGoRoundAConeIsASpline) {
  const Table table{axis_of('C', 1, {0, 0, 0}), axis_of('A', 1, {0, 0, 0})};
  const TurnedWay way = turned_way(table, {{9, 0, 0}, {9, 0, 0}, {30, 0, 0}, {30, 0, 100}});
  EXPECT_TRUE(std::holds_alternative<PoseSpline>(way.pieces.at(0)));
  EXPECT_FALSE(way.rests_askew);
  EXPECT_TRUE(turned_way(table, {{0, 0, 0}, {0, 0, 0}, {30, 0, 0}, {30, 0, 100}}).rests_askew);
}

TEST(TurnedWay, ElsewhereIsASplineWithinItsTolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-200, 200), angle(-400, 400);
  for (int seed = 0; seed < (kSanitized ? 5 : 50); ++seed) {
    SCOPED_TRACE(seed);
    const auto point = [&] { return Point{place(random), place(random), place(random)}; };
    Table table{axis_of('A', seed % 2 == 0 ? 1 : -1, point())};
    if (seed % 3 == 0) table.insert(table.begin(), axis_of(seed % 6 == 0 ? 'B' : 'C', 1, point()));
    const TableMove move{
        point(), point(), {angle(random), angle(random), angle(random)}, {angle(random), angle(random), angle(random)}};
    const TurnedWay way = turned_way(table, move);
    int pieces = 0, before = 0;
    for (const auto& piece : way.pieces) pieces += std::get<PoseSpline>(piece).pieces;
    double length = 0;
    Point last = expected(table, move, 0).tip;
    for (const auto& piece : way.pieces) {
      const auto& spline = std::get<PoseSpline>(piece);
      ASSERT_EQ(spline.points.size(), 3U * static_cast<std::size_t>(spline.pieces) + 3);
      for (int sample = 0; sample <= 20 * spline.pieces; ++sample) {
        const double at = sample / 20.0;
        const Pose found = value_of(spline, at);
        expect_near(found, expected(table, move, (before + at) / pieces), kSplineTolerance_mm, 1e-6);
        length += legacy::length(difference(found.tip, last));
        last = found.tip;
      }
      before += spline.pieces;
    }
    EXPECT_NEAR(way.length_mm, length, 1e-3 * length);
  }
}

/// Each piece turns by less than half a turn: three pieces of a whole one, whichever shape it has.
TEST(TurnedWay, IsCutIntoPiecesOfAThirdOfATurn) {
  const Table table{axis_of('C', 1, {0, 0, 0})};
  for (const double radius : {0.0, 7.0}) {
    for (const auto& [degrees, count] : std::vector<std::pair<double, std::size_t>>{
             {1, 1}, {-119, 1}, {120, 1}, {121, 2}, {-240, 2}, {241, 3}, {360, 3}, {1200, 10}}) {
      const TurnedWay way = turned_way(table, {{radius, 0, 1}, {radius, 0, 5}, {0, 0, 0}, {0, 0, degrees}});
      EXPECT_EQ(way.pieces.size(), count) << degrees << " at " << radius;
      EXPECT_EQ(way.turn_degrees, std::abs(degrees));
    }
  }
}

/// Both ways round, of a begin on either side: the last piece ends where the table's turn ends.
TEST(TurnedWay, EndsWhereTheTableTurnsItTo) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-90, 90), angle(-700, 700);
  for (int seed = 0; seed < 200; ++seed) {
    const Table table{axis_of(static_cast<char>('A' + seed % 3), seed % 2 == 0 ? 1 : -1,
                              {place(random), place(random), place(random)})};
    const Point from{place(random), place(random), place(random)};
    Point to = from;
    to.at(table.front().plane.normal) += seed % 5 == 0 ? 0 : place(random);
    TableMove move{from, to, {}, {}};
    move.begin.at(table.front().angle) = angle(random);
    move.end.at(table.front().angle) = angle(random);
    const TurnedWay way = turned_way(table, move);
    const Pose wanted = expected(table, move, 1);
    if (const auto* arc = std::get_if<TurnedArc>(&way.pieces.back())) {
      expect_near({arc->arc.end, arc->axis}, wanted, 1e-10, 1e-12);
      const double degrees = move.end.at(table.front().angle) - move.begin.at(table.front().angle);
      EXPECT_EQ(arc->arc.counter_clockwise, degrees * table.front().sign > 0);
    } else {
      const auto& spline = std::get<PoseSpline>(way.pieces.back());
      expect_near(value_of(spline, spline.pieces), wanted, 1e-10, 1e-12);
    }
  }
}

TEST(TurnedWay, OfAnArcOfUpToTwoMicrometresIsALineThatTurns) {
  const Table table{axis_of('C', 1, {0, 0, 0})};
  const auto pieces_at = [&](double radius, double degrees) {
    return turned_way(table, {{radius, 0, 0}, {radius, 0, 0}, {0, 0, 0}, {0, 0, degrees}}).pieces;
  };
  EXPECT_TRUE(std::holds_alternative<TurnedLine>(pieces_at(0.0019, 90).front()));
  EXPECT_TRUE(std::holds_alternative<TurnedArc>(pieces_at(0.0021, 90).front()));
  const double degrees_of_2um = 0.002 / 10 * 180 / std::numbers::pi;
  const auto line = pieces_at(10, 0.99 * degrees_of_2um);
  ASSERT_EQ(line.size(), 1U);
  ASSERT_TRUE(std::holds_alternative<TurnedLine>(line.front()));
  const TableMove move{{10, 0, 0}, {10, 0, 0}, {0, 0, 0}, {0, 0, 0.99 * degrees_of_2um}};
  expect_near({std::get<TurnedLine>(line.front()).end, std::get<TurnedLine>(line.front()).axis},
              expected(table, move, 1), 1e-12, 1e-12);
  EXPECT_NEAR(turned_way(table, move).length_mm, 0.00198, 1e-9);
  EXPECT_TRUE(std::holds_alternative<TurnedArc>(pieces_at(10, 1.01 * degrees_of_2um).front()));
}

/// A tip that is beside the axis by what digits round goes to its end at the end, where that is more than rest.
TEST(TurnedWay, OfATipBesideTheAxisByADigitEndsWhereItIsToEnd) {
  const Table table{axis_of('C', 1, {0, 0, 0})};
  for (const double beside : {0.0, 0.0002, 0.0004, 0.001, 0.0015}) {
    for (const double degrees : {90.0, -300.0}) {
      const TableMove move{{beside, 0, 3}, {beside, 0, 8}, {0, 0, 0}, {0, 0, degrees}};
      const TurnedWay way = turned_way(table, move);
      EXPECT_EQ(way.length_mm, 5);
      const auto& end = std::get<TurnedLine>(way.pieces.back());
      expect_near({end.end, end.axis}, expected(table, move, 1), 1e-12, 1e-12);
      const double off = legacy::length(difference(expected(table, move, 1).tip, {beside, 0, 8}));
      const std::size_t turns = std::abs(degrees) > 240 ? 3 : 1;
      EXPECT_EQ(way.pieces.size(), turns + (off > 5e-4 ? 1 : 0)) << beside << " " << degrees;
    }
  }
}

}  // namespace
}  // namespace rmac::gcode
