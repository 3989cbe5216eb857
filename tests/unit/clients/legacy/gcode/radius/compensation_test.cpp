// What the tool's centre does beside a contour.
#include "clients/legacy/gcode/radius/compensation.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {
namespace {

using legacy::Arc, legacy::Point;
using testing::HasSubstr;
using testing::SizeIs;

ContourMove line_to(double x, double y, double z = 0) {
  ContourMove move;
  move.end = {x, y, z};
  move.feed_mm_min = 100;
  return move;
}

ContourMove arc_to(double x, double y, double centre_x, double centre_y, bool left_turn, double z = 0) {
  ContourMove move = line_to(x, y, z);
  move.arc = Arc{.centre = {centre_x, centre_y, 0}, .end = move.end, .counter_clockwise = left_turn};
  return move;
}

struct Outcome {
  std::vector<ContourMove> moves;
  std::string refusal;
};

/// From the origin.
Outcome compensated(double left_mm, std::vector<ContourMove> contour) {
  Outcome outcome;
  Compensation compensation([&](const ContourMove& move, std::size_t) { outcome.moves.push_back(move); });
  try {
    compensation.begin(left_mm, {0, 0, 0});
    for (std::size_t number = 0; number < contour.size(); ++number) {
      contour[number].line = number + 1;
      compensation.move(contour[number], number);
    }
    compensation.end(0);
  } catch (const Refusal& refusal) {
    outcome.refusal = refusal.message;
  }
  return outcome;
}

void expect_at(const ContourMove& move, double x, double y, double z = 0) {
  EXPECT_NEAR(move.end[0], x, 1e-9);
  EXPECT_NEAR(move.end[1], y, 1e-9);
  EXPECT_NEAR(move.end[2], z, 1e-9);
}

TEST(Compensation, BeginsBesideTheEndOfItsFirstMove) {
  expect_at(compensated(2, {line_to(10, 0, -1)}).moves.at(0), 10, 2, -1);
  expect_at(compensated(-2, {line_to(0, 10)}).moves.at(0), 2, 10);
  EXPECT_THAT(compensated(2, {line_to(2, 0)}).refusal, HasSubstr("longer in X and Y than the tool's radius, 2 mm"));
  EXPECT_THAT(compensated(2, {line_to(0, 0, 5)}).refusal, HasSubstr("longer in X and Y"));
  EXPECT_THAT(compensated(2, {arc_to(10, 0, 5, 0, true)}).refusal, HasSubstr("is a straight one"));
}

TEST(Compensation, GoesAroundOutsideCornersAtTheFeedBehindThem) {
  auto behind = line_to(10, -10);
  behind.feed_mm_min = 50;
  const auto done = compensated(2, {line_to(10, 0), behind});
  ASSERT_THAT(done.moves, SizeIs(3));
  const ContourMove& corner = done.moves[1];
  ASSERT_TRUE(corner.arc);
  expect_at(corner, 12, 0);
  EXPECT_EQ(corner.arc->centre, (Point{10, 0, 0}));
  EXPECT_FALSE(corner.arc->counter_clockwise);
  EXPECT_EQ(corner.feed_mm_min, 50);
  EXPECT_EQ(corner.line, 2U);
  expect_at(done.moves[2], 12, -10);
}

TEST(Compensation, GoesAroundAReversal) {
  const auto done = compensated(-2, {line_to(10, 0), line_to(0, 0)});
  ASSERT_THAT(done.moves, SizeIs(3));
  EXPECT_TRUE(done.moves[1].arc->counter_clockwise);
  expect_at(done.moves[1], 10, 2);
  expect_at(done.moves[2], 0, 2);
}

TEST(Compensation, EndsInsideCornersWhereBothWaysCross) {
  const auto done = compensated(2, {line_to(10, 0), line_to(10, 10), line_to(0, 10)});
  ASSERT_THAT(done.moves, SizeIs(3));
  expect_at(done.moves[0], 8, 2);
  expect_at(done.moves[1], 8, 8);
  expect_at(done.moves[2], 0, 8);
}

TEST(Compensation, EndsItsFirstMoveBehindItsBeginWhereTheToolIsClearThere) {
  const auto done = compensated(2, {line_to(4, 0), line_to(-16, 15)});
  ASSERT_THAT(done.moves, SizeIs(2));
  expect_at(done.moves[0], -2, 2);  // a retreat of 6 from (4, 2), behind the begin at 0
  EXPECT_THAT(compensated(2, {line_to(4, 0), line_to(-36, 12)}).refusal, HasSubstr("corner between line 1 and this"))
      << "there the tool would begin within the next move";
}

TEST(Compensation, TakesDepthsInTheCorner) {
  const auto done = compensated(2, {line_to(10, 0), line_to(10, 0, -3), line_to(10, 0, -4), line_to(10, 10, -4)});
  ASSERT_THAT(done.moves, SizeIs(4));
  expect_at(done.moves[1], 8, 2, -3);
  expect_at(done.moves[2], 8, 2, -4);
  expect_at(done.moves[3], 8, 10, -4);
}

TEST(Compensation, KeepsACircleWholeBetweenTangentMoves) {
  auto circle = arc_to(10, 0, 10, 5, true);
  circle.arc->closed = true;
  circle.arc->more_turns = 2;
  const auto done = compensated(2, {line_to(10, 0), circle, line_to(20, 0)});
  ASSERT_THAT(done.moves, SizeIs(3));
  const Arc& arc = *done.moves[1].arc;
  EXPECT_TRUE(arc.closed);
  EXPECT_EQ(arc.more_turns, 2);
  EXPECT_EQ(arc.centre, (Point{10, 5, 0}));
  expect_at(done.moves[1], 10, 2);
}

TEST(Compensation, CutsACircleShortInAnInsideCorner) {
  auto circle = arc_to(10, 0, 5, 0, true);
  circle.arc->closed = true;
  const auto done = compensated(2, {line_to(10, 0), circle});
  ASSERT_THAT(done.moves, SizeIs(2));
  expect_at(done.moves[0], 5 + std::sqrt(5), 2);
  EXPECT_FALSE(done.moves[1].arc->closed);
  EXPECT_EQ(done.moves[1].arc->more_turns, 0);
  expect_at(done.moves[1], 8, 0);
}

TEST(Compensation, IsRefusedWhereTheToolDoesNotGetIn) {
  EXPECT_THAT(compensated(5, {line_to(20, 0), arc_to(20, 8, 20, 4, true)}).refusal,
              HasSubstr("does not get into this arc"));
  EXPECT_EQ(compensated(-5, {line_to(20, 0), arc_to(20, 8, 20, 4, true)}).refusal, "") << "around it, it gets";
  EXPECT_THAT(compensated(2, {line_to(10, 0), line_to(10, 3), line_to(0, 3)}).refusal,
              HasSubstr("does not get into the corner between line 2 and this"));
  EXPECT_THAT(compensated(2, {line_to(10, 0), line_to(10, 1)}).refusal, HasSubstr("corner between line 1 and this"));
}

/// The distance from a place to a line's or an arc's points, from above: enough to see a gouge.
double distance_to(const Point& from, const ContourMove& move, const Point& place) {
  double least = 1e9;
  for (int step = 0; step <= 400; ++step) {
    const double part = step / 400.0;
    Point on{from[0] + (move.end[0] - from[0]) * part, from[1] + (move.end[1] - from[1]) * part, 0};
    if (move.arc) {
      const auto& centre = move.arc->centre;
      const double radius = std::hypot(from[0] - centre[0], from[1] - centre[1]);
      const double begin = std::atan2(from[1] - centre[1], from[0] - centre[0]);
      double sweep = std::atan2(move.end[1] - centre[1], move.end[0] - centre[0]) - begin;
      if (!move.arc->counter_clockwise) sweep = -sweep;
      while (sweep < 0) sweep += 2 * std::numbers::pi;
      const double angle = begin + (move.arc->counter_clockwise ? sweep : -sweep) * part;
      on = {centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle), 0};
    }
    least = std::min(least, std::hypot(on[0] - place[0], on[1] - place[1]));
  }
  return least;
}

/// Random contours of lines and arcs: where neighbours meet, the tool's centre is a radius from both.
TEST(Compensation, KeepsItsDistanceFromBothMovesOfACorner) {
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> number(0, 1);
  int corners = 0;
  for (int contour = 0; contour < 400; ++contour) {
    const double left = number(random) < 0.5 ? 1 : -1;
    std::vector<ContourMove> moves{line_to(6, 0)};
    double direction = 0;
    for (int part = 0; part < 4; ++part) {
      const Point at = moves.back().end;
      direction += number(random) * 4 - 2;
      const double length = 4 + 6 * number(random), turn = number(random) < 0.5 ? 1 : -1, sweep = 0.5 + number(random);
      if (number(random) < 0.5) {
        moves.push_back(line_to(at[0] + length * std::cos(direction), at[1] + length * std::sin(direction)));
        continue;
      }
      const Point centre{at[0] - turn * length * std::sin(direction), at[1] + turn * length * std::cos(direction), 0};
      const double angle = std::atan2(at[1] - centre[1], at[0] - centre[0]) + turn * sweep;
      moves.push_back(arc_to(centre[0] + length * std::cos(angle), centre[1] + length * std::sin(angle), centre[0],
                             centre[1], turn > 0));
      direction += turn * sweep;
    }
    const auto done = compensated(left, moves);
    if (!done.refusal.empty()) continue;
    for (std::size_t given = 0; given < done.moves.size(); ++given) {
      const std::size_t of = done.moves[given].line - 1;
      const Point from = of == 0 ? Point{} : moves[of - 1].end;
      EXPECT_NEAR(distance_to(from, moves[of], done.moves[given].end), 1, 1e-3) << contour << ": " << given;
      if (of + 1 < moves.size()) {
        EXPECT_GE(distance_to(moves[of].end, moves[of + 1], done.moves[given].end), 1 - 1e-3)
            << contour << ": " << given;
      }
      ++corners;
    }
  }
  EXPECT_GT(corners, 500);
}

/// How far the radii of an arc at its begin and end are apart.
double gap(const Point& from, const Arc& arc) {
  return std::hypot(from[0] - arc.centre[0], from[1] - arc.centre[1]) -
         std::hypot(arc.end[0] - arc.centre[0], arc.end[1] - arc.centre[1]);
}

/// A rectangle with rounded corners, anywhere, written to a micrometre, as CAM programs do: neighbours are tangent but
/// for rounding, and turn a little to either side.
TEST(Compensation, TakesTangentContoursThatAreRounded) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0, 1);
  const auto rounded = [](double value) { return std::round(value * 1000) / 1000; };
  for (int contour = 0; contour < 300; ++contour) {
    const double turn = number(random) * 6, left = number(random) < 0.5 ? 2 : -2;
    const auto place = [&](double x, double y) {
      return Point{rounded(x * std::cos(turn) - y * std::sin(turn)), rounded(x * std::sin(turn) + y * std::cos(turn)),
                   0};
    };
    std::vector<ContourMove> moves{line_to(place(10, 0)[0], place(10, 0)[1])};
    const std::array<std::array<Point, 3>, 4> corners{{{place(20, 0), place(20, 3), place(23, 3)},
                                                       {place(23, 20), place(20, 20), place(20, 23)},
                                                       {place(5, 23), place(5, 20), place(2, 20)},
                                                       {place(2, 3), place(5, 3), place(5, 0)}}};
    for (const auto& [begin, centre, end] : corners) {
      moves.push_back(line_to(begin[0], begin[1]));
      auto arc = arc_to(end[0], end[1], centre[0], centre[1], true);
      moves.push_back(arc);
    }
    moves.push_back(line_to(place(12, 0)[0], place(12, 0)[1]));
    const auto done = compensated(left, moves);
    ASSERT_EQ(done.refusal, "") << contour;
    Point at{};
    for (const ContourMove& move : done.moves) {
      // An arc begins and ends on its circle.
      if (move.arc) {
        EXPECT_NEAR(gap(at, *move.arc), 0, 1e-4) << contour << ", line " << move.line;
      }
      at = move.end;
      const std::size_t of = move.line - 1;
      const Point from = of == 0 ? Point{} : moves[of - 1].end;
      EXPECT_NEAR(distance_to(from, moves[of], move.end), std::abs(left), 0.01) << contour << ", line " << move.line;
    }
  }
}

/// At an outside corner of any angle the tool goes about the corner, and at an inside one to where both ways cross; on
/// either side, and the whole way it is as far from the contour as its radius.
TEST(Compensation, TurnsCornersOfEveryAngle) {
  for (const double left : {3.0, -3.0}) {
    for (int degrees = -179; degrees <= 179; ++degrees) {
      SCOPED_TRACE(degrees);
      const double turn = degrees * std::numbers::pi / 180;
      const Point end{50 + 60 * std::cos(turn), 60 * std::sin(turn), 0};
      const auto done = compensated(left, {line_to(50, 0), line_to(end[0], end[1])});
      const bool outside = degrees * left < 0;
      const double reach = 3 / std::tan((std::numbers::pi - std::abs(turn)) / 2);  // of an inside corner
      if (!outside && reach > 45) continue;                                        // the tool does not get in
      ASSERT_EQ(done.refusal, "");
      const Flat normal{-std::sin(turn) * left, std::cos(turn) * left};
      expect_at(done.moves.back(), end[0] + normal.x, end[1] + normal.y);
      if (std::abs(degrees) < 1) {
        EXPECT_THAT(done.moves, SizeIs(2));
        expect_at(done.moves[0], 50, left);
      } else if (outside) {
        ASSERT_THAT(done.moves, SizeIs(3));
        expect_at(done.moves[0], 50, left);
        ASSERT_TRUE(done.moves[1].arc);
        expect_at(done.moves[1], 50 + normal.x, normal.y);
        EXPECT_EQ(done.moves[1].arc->centre, (Point{50, 0, 0}));
        EXPECT_EQ(done.moves[1].arc->counter_clockwise, left < 0);
      } else {
        ASSERT_THAT(done.moves, SizeIs(2));
        expect_at(done.moves[0], 50 - reach, left);
      }
    }
  }
}

}  // namespace
}  // namespace rmac::gcode
