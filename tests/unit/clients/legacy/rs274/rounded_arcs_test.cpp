#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::SizeIs;

constexpr double kTurn = 2 * std::numbers::pi;

struct Spot {
  double x, y;
};

Spot spot_of(const json& params, const char* key) {
  return {params[key]["p"][0], params[key]["p"][1]};
}

double distance(Spot a, Spot b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// By angles alone, as rs274 has it.
double sweep_of(Spot start, Spot end, Spot centre, bool left) {
  const double turn =
      std::atan2(end.y - centre.y, end.x - centre.x) - std::atan2(start.y - centre.y, start.x - centre.x);
  const double sweep = std::fmod((left ? turn : -turn) + 2 * kTurn, kTurn);
  return sweep <= 1e-6 ? sweep + kTurn : sweep;
}

struct Programmed {
  Spot start{}, end{}, centre{};
  bool left = false;
  std::string lines;
};

/// Rounded to the digits of a unit; of all sizes, and many nearly closed.
Programmed rounded_arc(std::mt19937& random) {
  const auto uniform = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  Programmed arc;
  const bool inch = uniform(0, 1) < 0.5;
  const double unit = inch ? 25.4 : 1, step = inch ? 1e-4 : 1e-3;
  const auto round = [step](double value) { return std::round(value / step) * step; };
  const double radius = std::pow(10, uniform(-1, 3)) / unit, begin = uniform(0, kTurn);
  const double least = std::min(0.05 / unit / radius, 1.0);
  const double part = uniform(0, 1), near = least * std::pow(kTurn / 2 / least, uniform(0, 1));
  const double sweep = part < 0.4 ? kTurn - near : part < 0.7 ? near : uniform(least, kTurn - least);
  arc.left = uniform(0, 1) < 0.5;
  const Spot centre{uniform(-50, 50) / unit, uniform(-50, 50) / unit};
  const auto at = [&](double angle) {
    return Spot{round(centre.x + radius * std::cos(angle)), round(centre.y + radius * std::sin(angle))};
  };
  const Spot start = at(begin), end = at(begin + (arc.left ? sweep : -sweep));
  const Spot way{round(centre.x - start.x), round(centre.y - start.y)};
  const int digits = inch ? 4 : 3;
  arc.lines = fmt::format("G{} G0 X{:.{}f} Y{:.{}f} Z0\nG{} X{:.{}f} Y{:.{}f} I{:.{}f} J{:.{}f}", inch ? 20 : 21,
                          start.x, digits, start.y, digits, arc.left ? 3 : 2, end.x, digits, end.y, digits, way.x,
                          digits, way.y, digits);
  arc.start = {start.x * unit, start.y * unit};
  arc.end = {end.x * unit, end.y * unit};
  arc.centre = {arc.start.x + way.x * unit, arc.start.y + way.y * unit};
  return arc;
}

/// Farthest that the moves are from the circle about the centre as written, through the start.
double strays(const Programmed& wanted, const json& params) {
  const double radius = distance(wanted.start, wanted.centre);
  const Spot centre = spot_of(params, "CenterPoint"), start = spot_of(params, "StartPoint"),
             end = spot_of(params, "EndPoint");
  const bool left = params["RotSign"] == 1;
  const double sweep = params["Closed"] == true ? kTurn : sweep_of(start, end, centre, left);
  const double begin = std::atan2(start.y - centre.y, start.x - centre.x), own = distance(start, centre);
  double most = 0;
  for (int i = 0; i <= 200; ++i) {
    const double angle = begin + (left ? sweep : -sweep) * i / 200;
    const Spot at{centre.x + own * std::cos(angle), centre.y + own * std::sin(angle)};
    most = std::max(most, std::abs(distance(at, wanted.centre) - radius));
  }
  return most;
}

TEST(Rs274RoundedArc, StaysOnTheCircleThatWasWritten) {
  std::mt19937 random(11);
  for (int i = 0; i < 6000 && !testing::Test::HasFailure(); ++i) {
    const Programmed wanted = rounded_arc(random);
    SCOPED_TRACE(wanted.lines);
    const double radius = distance(wanted.start, wanted.centre);
    const double off = std::abs(radius - distance(wanted.end, wanted.centre));
    if (off > 0.005 && off > 1e-3 * radius) continue;  // rs274 refuses it as well
    const auto done = imported(program_of(wanted.lines));
    Spot at = wanted.start;
    double length = 0;
    int arcs = 0;
    for (const auto& request : done.requests) {
      const json& params = request["params"];
      if (!params.contains("EndPoint")) continue;
      EXPECT_NEAR(distance(at, spot_of(params, "StartPoint")), 0, 2e-7);
      at = spot_of(params, "EndPoint");
      if (!params.contains("RotSign")) {
        EXPECT_LE(distance(at, spot_of(params, "StartPoint")), off + 1.1e-3);
        continue;
      }
      ++arcs;
      const Spot centre = spot_of(params, "CenterPoint");
      const bool closed = params["Closed"];
      EXPECT_NEAR(distance(spot_of(params, "StartPoint"), centre), distance(at, centre), 4e-7);
      length =
          distance(at, centre) * (closed ? kTurn : sweep_of(spot_of(params, "StartPoint"), at, centre, wanted.left));
      EXPECT_LE(strays(wanted, params), off + 1e-3);
    }
    EXPECT_NEAR(distance(at, wanted.end), 0, 2e-7);
    EXPECT_EQ(arcs, 1);
    EXPECT_NEAR(length, radius * sweep_of(wanted.start, wanted.end, wanted.centre, wanted.left), 5 * off + 2e-3);
  }
}

TEST(Rs274RoundedArc, KeepsItsCentreAndHasALineToItsEndWhereItNearlyCloses) {
  const auto done = imported(program_of("G1 X5\nG3 X5.003 Y-.05 I-5"));
  ASSERT_THAT(done.methods,
              ElementsAre("MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveAlongArc", "MoveAlongLine"));
  EXPECT_EQ(done.requests[3]["params"]["CenterPoint"]["p"], json({0, 0, 10}));
  EXPECT_EQ(done.requests[4]["params"]["EndPoint"]["p"], json({5.003, -0.05, 10}));
  EXPECT_EQ(done.requests[4]["params"]["MoveID"], done.requests[3]["params"]["MoveID"]);
}

TEST(Rs274RoundedArc, IsAFullTurnWhereItsEndIsRightBesideItsStart) {
  const auto done = imported(program_of("G1 X10.4\nG3 X10.4015 Y0 I-.4"));
  ASSERT_THAT(done.requests, SizeIs(5));
  EXPECT_EQ(done.requests[3]["params"]["Closed"], true);
  EXPECT_EQ(done.requests[3]["params"]["EndPoint"], done.requests[3]["params"]["StartPoint"]);
}

TEST(Rs274RoundedArc, OfAShortWayIsTakenWhateverItsRadius) {
  for (const char* lines : {"G1 X1000\nG3 X999.999 Y.25 I-1000", "G1 X100\nG3 X99.999 Y.15 I-100"}) {
    const auto done = imported(program_of(lines));
    EXPECT_THAT(done.methods, ElementsAre("MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveAlongArc")) << lines;
  }
}

/// What the appliance takes for one place is closed; the next arc begins where it was programmed to.
TEST(Rs274RoundedArc, DoesNotDriftOverEndsThatAreNearlyOnePlace) {
  const auto done = imported(program_of("G1 X10\nG2 X10 Y.0005 I-10 J0\nX10 Y.001 I-10 J0\nX10 Y.0015 I-10 J0"));
  json at{{"p", {0, 0, 10}}};
  int arcs = 0;
  for (const auto& request : done.requests) {
    const json& params = request["params"];
    if (!params.contains("EndPoint")) continue;
    EXPECT_EQ(params["StartPoint"]["p"], at["p"]);
    at = params["EndPoint"];
    if (!params.contains("RotSign")) continue;
    ++arcs;
    EXPECT_EQ(params["Closed"], true);
    EXPECT_EQ(params["StartPoint"], params["EndPoint"]);
  }
  EXPECT_EQ(arcs, 3);
  EXPECT_EQ(at["p"], json({10, 0.0015, 10}));
}

}  // namespace
}  // namespace rmac::rs274
