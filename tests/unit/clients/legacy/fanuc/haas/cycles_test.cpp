#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "unit/clients/legacy/fanuc/haas/imported.hpp"

namespace rmac::fanuc::haas {
namespace {

using nlohmann::json;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kSame_mm = 2e-7;

struct Pocket {
  double first = 0, last = 0, step = 0, tool = 0;
  bool counter_clockwise = false;
  [[nodiscard]] std::string lines() const {
    return fmt::format("G0 X20. Y-5.\nG{} I{:.4f} K{:.4f} Q{:.4f} Z-2. D1 F200.", counter_clockwise ? 13 : 12, first,
                       last, step);
  }
};

struct Turn {
  std::array<double, 2> start{}, end{}, centre{};
  bool counter_clockwise = false;
  [[nodiscard]] double radius() const { return std::hypot(end[0] - centre[0], end[1] - centre[1]); }
  /// Which way the tool goes at a place of it, of unit length.
  [[nodiscard]] std::array<double, 2> way_at(const std::array<double, 2>& place) const {
    const double sense = (counter_clockwise ? 1 : -1) / radius();
    return {-sense * (place[1] - centre[1]), sense * (place[0] - centre[0])};
  }
  [[nodiscard]] bool closed() const { return std::hypot(end[0] - start[0], end[1] - start[1]) < kSame_mm; }
};

/// The arcs of a pocket, about its middle.
std::vector<Turn> turns_of(const legacy::Imported& pocket, const std::array<double, 2>& middle) {
  const auto place = [&middle](const json& frame) {
    return std::array{frame["p"][0].get<double>() - middle[0], frame["p"][1].get<double>() - middle[1]};
  };
  std::vector<Turn> turns;
  for (const auto& request : pocket.requests) {
    const auto& params = request["params"];
    if (request["method"] != "RMAC_CAM.MoveAlongArc") continue;
    turns.push_back(
        {place(params["StartPoint"]), place(params["EndPoint"]), place(params["CenterPoint"]), params["RotSign"] == 1});
  }
  return turns;
}

TEST(HaasPocket, ClearsItsCircleAndNothingElse) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    Pocket pocket{.first = 3 + 4 * share(random), .tool = 4, .counter_clockwise = trial % 2 == 0};
    pocket.last = pocket.first + 0.5 + 20 * share(random);
    pocket.step = 0.3 + 3 * share(random);
    SCOPED_TRACE(pocket.lines());
    Options options;
    options.tool_diameters_mm = {{1, pocket.tool}};
    const auto turns = turns_of(done(pocket.lines(), options), {20, -5});
    ASSERT_FALSE(turns.empty());
    const double last = pocket.last - pocket.tool / 2;
    double cleared = 0;
    std::array<double, 2> here{}, way = turns.front().way_at({});
    for (const Turn& turn : turns) {
      EXPECT_EQ(turn.counter_clockwise, pocket.counter_clockwise);
      EXPECT_LT(std::hypot(turn.start[0] - here[0], turn.start[1] - here[1]), kSame_mm) << "goes on where it was";
      EXPECT_NEAR(way[0] * turn.way_at(here)[0] + way[1] * turn.way_at(here)[1], 1, 1e-6) << "and the way it went";
      here = turn.end;
      way = turn.way_at(here);
      EXPECT_LE(std::hypot(turn.centre[0], turn.centre[1]) + turn.radius(), last + 1e-3) << "stays within the circle";
      if (!turn.closed()) continue;
      EXPECT_NEAR(std::hypot(turn.centre[0], turn.centre[1]), 0, kSame_mm);
      EXPECT_LE(turn.radius() - cleared, std::max(pocket.step, pocket.first - pocket.tool / 2) + 1e-3);
      EXPECT_GT(turn.radius(), cleared);
      cleared = turn.radius();
    }
    EXPECT_NEAR(cleared, last, 1e-3);
    EXPECT_LT(std::hypot(here[0], here[1]), kSame_mm) << "and is back in the middle";
  }
}

TEST(HaasPocket, GoesDownAtFeedAndIsACircleByIAlone) {
  Options options;
  options.tool_diameters_mm = {{1, 4}};
  const auto all = done("G13 I10. Z-2. D1 F200.\nX1.", options);
  EXPECT_THAT(all.methods, ElementsAre("MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveAlongArc",
                                       "MoveAlongArc", "MoveAlongArc", "MoveToPathTarget"))
      << "behind it G0 is in force again";
  EXPECT_THAT(legacy::ends_in(all), ElementsAre(ElementsAre(0, 0, -2), ElementsAre(8, 0, -2), ElementsAre(8, 0, -2),
                                                ElementsAre(DoubleNear(0, kSame_mm), 0, -2), ElementsAre(1, 0, -2)));
  EXPECT_EQ(all.requests[1]["params"]["Feedrate"], 200);
  EXPECT_EQ(done("G1 Y0\nG12 I1. Z-2. D0\nX1.").methods.back(), "MoveAlongLine");
}

TEST(HaasPocket, GoesDownAgainAndAgainUnderG91) {
  Options options;
  options.tool_diameters_mm = {{2, 6.35}};
  std::vector<double> depths;
  // As a shop wrote it.
  const auto all = imported(
      "%\nO1\nG20 G90 G54\nG00 X0.75 Y-1.349 Z1.\nG01 Z0. F40.\nG13 G91 Z-0.05 D02 I0.130 K0.199 Q0.01 L8 "
      "F10.\nG90\nG00 Z0.1\nM30\n%\n",
      options, Dialect::Haas);
  for (const auto& request : all.requests) {
    if (request["method"] == "RMAC_CAM.MoveAlongLine") depths.push_back(request["params"]["EndPoint"]["p"][2]);
  }
  EXPECT_THAT(depths, ElementsAre(DoubleNear(0, 1e-6), DoubleNear(-1.27, 1e-6), DoubleNear(-2.54, 1e-6),
                                  DoubleNear(-3.81, 1e-6), DoubleNear(-5.08, 1e-6), DoubleNear(-6.35, 1e-6),
                                  DoubleNear(-7.62, 1e-6), DoubleNear(-8.89, 1e-6), DoubleNear(-10.16, 1e-6)));
  const auto turns = turns_of(all, {0.75 * 25.4, -1.349 * 25.4});
  EXPECT_NEAR(turns.back().radius() * 2, (0.199 - 0.125) * 25.4, 1e-3) << "half a turn leads back";
  EXPECT_EQ(turns.size() % 8, 0U);
}

TEST(HaasPocket, LiesWhereCoordinatesAreTurned) {
  const auto all = done("G68 X0 Y0 R90.\nG0 X10. Y0 Z10.\nG13 I2. Z0 D0");
  const auto turns = turns_of(all, {0, 10});
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_NEAR(turns[1].radius(), 2, kSame_mm);
  EXPECT_NEAR(turns[0].end[1], 2, kSame_mm);
}

TEST(HaasPocket, IsRefusedWhereItIsNone) {
  Options options;
  options.tool_diameters_mm = {{1, 4}};
  const std::vector<std::pair<std::string, std::string>> cases{
      {"G13 I2. Z-1. D1", "more than that of the tool"},
      {"G13 I5. K4. Q1. Z-1. D1", "more than I"},
      {"G13 I5. K9. Z-1. D1", "needs Q"},
      {"G13 I5. K9. Q0. Z-1. D1", "more than 0"},
      {"G13 I5. K900. Q.001 Z-1. D1", "circles"},
      {"G13 I5. Q1. Z-1. D1", "goes with K"},
      {"G13 I5. Z-1. L2 D1", "write G91"},
      {"G13 Z-1. D1", "needs I"},
      {"G13 I5. D1", "needs Z, its depth"},
      {"G13 I5. Z-1.", "write D"},
      {"G13 I5. Z-1. D7", "--tool-diameter 7"},
      {"G13 I5. Z-1. D1 R3.", "nothing in this block uses R"},
      {"G13 G12 I5. Z-1. D1", "write two blocks"},
      {"G13 G4 I5. Z-1. D1 P1", "write two blocks"},
      {"G2 G13 I5. Z-1. D1", "write two blocks"},
      {"G13 I5. Z-1. D1 M9", "block of its own"},
      {"G18 G13 I5. Z-1. D1", "G17"},
      {"G99 G81 Z-1. R2.\nG13 I5. Z-1. D1", "write G80"},
      {"T1 M6\nG43\nG13 I5. Z-1. D1", "not known here"},
      {"G93 G13 I5. Z-1. D1 F2.", "G93"},
      {"G66 P9\nG13 I5. Z-1. D1", "write G67"},
  };
  for (const auto& [lines, what] : cases) EXPECT_THAT(refusal(lines, options, "O9\nM99\n"), HasSubstr(what)) << lines;
}

}  // namespace
}  // namespace rmac::fanuc::haas
