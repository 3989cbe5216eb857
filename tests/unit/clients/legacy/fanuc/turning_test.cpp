#include <gmock/gmock.h>

#include <numbers>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using nlohmann::json;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const double kHalf = std::sqrt(0.5);

auto near(double x, double y, double z) {
  return ElementsAre(DoubleNear(x, 1e-6), DoubleNear(y, 1e-6), DoubleNear(z, 1e-6));
}

std::vector<double> end_at(const json& move) {
  return legacy::end_of(move)["p"].get<std::vector<double>>();
}

std::vector<double> axis_at_end(const json& move) {
  return legacy::end_of(move)["axis"].get<std::vector<double>>();
}

TEST(FanucTurn, IsAboutItsCentreUntilG69) {
  EXPECT_THAT(ends_of("G68 X1. Y0 R90.\nG0 X3. Y0\nG1 X3. Y1.\nG69\nG0 X0 Y0"),
              ElementsAre(near(1, 2, 10), near(0, 2, 10), near(0, 0, 10)));
  EXPECT_THAT(ends_of("G0 X5. Y5.\nG68 R90.\nX6. Y5."),
              ElementsAre(near(5, 5, 10), near(5, 6, 10)));                              // where the tool is
  EXPECT_THAT(ends_of("G18\nG68 X0 Z0 R90.\nG0 X0 Z10."), ElementsAre(near(10, 0, 0)));  // in ZX, Z towards X
}

TEST(FanucTurn, LeavesArcsWhatTheyAre) {
  const auto moves =
      legacy::moves_in(imported(program_of("G68 X0 Y0 R90.\nG0 X10. Y0\nG2 X0 Y10. R-10.\nG3 I0 J-10. Z5.")));
  EXPECT_EQ(moves[1]["params"]["RotSign"], -1);
  EXPECT_EQ(moves[1]["params"]["CenterPoint"]["p"], json({0, 0, 10}));
  EXPECT_THAT(end_at(moves[1]), near(-10, 0, 10));
  EXPECT_EQ(moves[2]["params"]["CenterPoint"]["axis"], json({0, 0, 1}));
  EXPECT_THAT(end_at(moves[2]), near(-10, 0, 5));
}

TEST(FanucTurn, TurnsCyclesAndContours) {
  EXPECT_THAT(ends_of("G68 X0 Y0 R180.\nG99 G81 X5. Y1. Z-1. R2.").back(), near(-5, -1, 2));
  Options options;
  options.tool_diameters_mm = {{1, 2}};
  EXPECT_THAT(ends_of("G68 X0 Y0 R90.\nG1 X0 Y-5.\nG41 D1 X10.\nX20.\nG40 Y0", options)[2], near(4, 20, 10));
}

/// Where the program believes an axis to be that the block does not name, manuals leave open.
TEST(FanucTurn, WantsBothAxesOfItsFirstMove) {
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\nG0 X3.")), StartsWith("6:1: behind G68, G69"));
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\nG0 X1. Y1.\nG69\nY3.")), StartsWith("8:1: behind G68, G69"));
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\nG91 G0 X3. Y1.")), HasSubstr("under G90"));
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\nG2 X3. Y1. R9.")), HasSubstr("a straight move stands first"));
  EXPECT_THAT(ends_of("G68 X0 Y0 R90.\nG0 Z3.\nX1. Y0"), ElementsAre(near(0, 0, 3), near(0, 1, 3)));
}

TEST(FanucTurn, IsRefusedWhereItMeansMore) {
  Options options;
  options.reference_mm = {{0, 0, 50}};
  options.offsets[0] = options.offsets[1] = {0, 0, 0};
  for (const std::string line :
       {"G28 X0", "G55", "G52 X1.", "G92 X1.", "G10 L2 P1 X1. Y0 Z0", "G68 X0 Y0 R5.", "G0 G53 Z0", "G51.1 X0"})
    EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\nG0 X1. Y1.\n" + line), options), StartsWith("7:")) << line;
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0")), HasSubstr("needs R"));
  EXPECT_THAT(refusal_of(program_of("G91 G68 X0 Y0 R5.")), HasSubstr("under G91"));
  EXPECT_THAT(refusal_of(program_of("G51 X0 Y0 P2.")), HasSubstr("scaling"));
}

TEST(FanucMirror, TurnsTheWayOfArcs) {
  const auto moves =
      legacy::moves_in(imported(program_of("G51.1 X5.\nG0 X0 Y0\nG2 X10. Y10. R10.\nG50.1 X0\nG0 X1. Y1.")));
  EXPECT_THAT(end_at(moves[0]), near(10, 0, 10));
  EXPECT_EQ(moves[1]["params"]["RotSign"], 1);
  EXPECT_EQ(moves[1]["params"]["CenterPoint"]["p"], json({0, 0, 10}));
  EXPECT_THAT(end_at(moves[1]), near(0, 10, 10));
  EXPECT_THAT(end_at(moves[2]), near(1, 1, 10));
}

TEST(FanucMirror, ComesBeforeATurn) {
  EXPECT_THAT(ends_of("G51.1 X0\nG68 X0 Y0 R90.\nG0 X3. Y1.").back(), near(1, 3, 10));
  EXPECT_THAT(ends_of("G51.1 X0\nG68 X0 Y0 R30.\nG0 X10. Y0").back(), near(-10 * std::sqrt(0.75), 5, 10));
  EXPECT_THAT(ends_of("G51.1 X0 Y0\nG68 X0 Y0 R30.\nG0 X10. Y0").back(), near(-10 * std::sqrt(0.75), -5, 10));
  EXPECT_THAT(refusal_of(program_of("G51.1 X0\nG68 X1. Y0 R30.")), StartsWith("6:1: the centre of a turn"));
  EXPECT_THAT(refusal_of(program_of("G51.1 X0\nG18\nG68 X0 Z0 R30.")), StartsWith("7:1: a mirror and a turn"));
}

TEST(FanucTilt, IsByEulersAnglesAndTurnsTheTool) {
  const auto moves =
      legacy::moves_in(imported(program_of("G68.2 X10. Y0 Z0 I90. J45. K0\nG53.1\nG0 X0 Y0 Z5.\nG1 Z0\nX1.")));
  // About Z by 90 degrees, then about the new X, which is Y: the normal leans towards X.
  EXPECT_THAT(axis_at_end(moves[0]), near(kHalf, 0, kHalf));
  EXPECT_THAT(end_at(moves[0]), near(0, 0, 10)) << "the tip stays where it is";
  EXPECT_THAT(end_at(moves[1]), near(10 + 5 * kHalf, 0, 5 * kHalf));
  EXPECT_THAT(end_at(moves[2]), near(10, 0, 0));
  EXPECT_THAT(end_at(moves[3]), near(10, 1, 0));
}

TEST(FanucTilt, TakesCyclesAndArcsInItsPlane) {
  const auto moves = legacy::moves_in(
      imported(program_of("G68.2 X0 Y0 Z0 I0 J90. K0\nG53.1\nG0 X0 Y0 Z5.\nG2 X10. Y0 R5.\nG99 G81 X1. Y2. Z-3. R1.")));
  EXPECT_THAT(moves[2]["params"]["CenterPoint"]["axis"].get<std::vector<double>>(), near(0, -1, 0));
  EXPECT_EQ(moves[2]["params"]["RotSign"], -1);
  EXPECT_THAT(end_at(moves.back()), near(1, -1, 2));  // Z of the plane is -Y, its Y is Z
}

TEST(FanucTilt, IsRefusedInOtherWays) {
  EXPECT_THAT(refusal_of(program_of("G68.2 P1 X0 Y0 Z0 I0 J90. K0")), HasSubstr("Euler's angles"));
  EXPECT_THAT(refusal_of(program_of("G53.1")), HasSubstr("write G68.2 before it"));
  EXPECT_THAT(refusal_of(program_of("G68.2 X0 Y0 Z0 J9.\nG68.2 X0 Y0 Z0 J9.")), StartsWith("6:1: G68.2 in turned"));
  EXPECT_THAT(refusal_of(program_of("G68.3 X0 Y0 Z0")), HasSubstr("Euler's angles"));
}

TEST(FanucToolAxis, OfAnglesGoesByTheAxesThatAreNamed) {
  Options options;
  options.rotary = {{'C', 1}, {'A', 1}};
  const auto axes = [&options](const std::string& lines) {
    std::vector<std::vector<double>> result;
    for (const auto& move : legacy::moves_in(imported(program_of(lines), options))) result.push_back(axis_at_end(move));
    return result;
  };
  EXPECT_THAT(axes("G43.4\nG1 X1. A90. C0\nX2. A90. C90.\nG91 X1. C-90."),
              ElementsAre(near(0, -1, 0), near(1, 0, 0), near(0, -1, 0)));
  EXPECT_THAT(axes("G43.4\nG0 A45. C0\nG1 C90."), ElementsAre(near(0, -kHalf, kHalf), near(kHalf, 0, kHalf)))
      << "the tip stays";
  options.rotary = {{'C', -1}, {'B', 1}};
  EXPECT_THAT(axes("G43.4\nG1 X1. B90. C90."), ElementsAre(near(0, -1, 0)));
  EXPECT_THAT(refusal_of(program_of("G43.4\nG1 X1. B9."), options),
              StartsWith("6:8: where axis C stands is not known"));
  EXPECT_THAT(refusal_of(program_of("G43.4\nG1 X1. A9."), options), HasSubstr("give --rotary"));
  EXPECT_THAT(refusal_of(program_of("G43.4\nG1 X1. B9 C0"), options), HasSubstr("no decimal point"));
}

TEST(FanucToolAxis, OfAnglesWithoutG43_4LeavesTheTipNobodyKnowsWhere) {
  Options options;
  options.rotary = {{'C', 1}, {'A', 1}};
  EXPECT_THAT(refusal_of(program_of("G0 A90. C0\nA0.\nG0 X1."), options),
              HasSubstr("where the tool is before this move is not known"));
  EXPECT_THAT(ends_of("G0 A90. C0\nG0 A0.\nG0 X1. Y1. Z1.", options).back(), near(1, 1, 1));
  EXPECT_THAT(refusal_of(program_of("G52 X0 A90. C0"), options), HasSubstr("block of its own"));
  EXPECT_THAT(refusal_of(program_of("G0 X1. A90. C0"), options), HasSubstr("have the post write G43.4"));
  EXPECT_THAT(ends_of("G0 A0. C0 X1.", options), ElementsAre(near(1, 0, 10)));
  EXPECT_THAT(ends_of("G0 A0. B0 X1."), ElementsAre(near(1, 0, 10))) << "an axis that stands at 0 means nothing";
}

TEST(FanucToolAxis, LeavesXYZToTheMachineWhereNothingSaysWhereThePartIs) {
  Options options;
  options.rotary = {{'C', 1}, {'A', 1}};
  options.reference_mm = {{0, 0, 200}};
  const auto refused = HasSubstr("X, Y and Z are those of the machine");
  EXPECT_THAT(refusal_of(program_of("G0 A90. C0\nG0 X1. Y1. Z1."), options), refused)
      << "a hole along the part's Z by a tool that lies in it";
  EXPECT_THAT(refusal_of(program_of("G0 A0. C90.\nG0 X1. Y1. Z1."), options), refused) << "the tool points along Z";
  EXPECT_THAT(refusal_of(program_of("G43.4\nG1 X1. A90. C0\nG49\nX2."), options), refused);
  EXPECT_THAT(refusal_of(program_of("G43.5\nG1 X1. I1. J0 K0\nG49\nX2.")), refused);
  EXPECT_THAT(refusal_of(program_of("G68.2 X0 Y0 Z0 I0 J90. K0\nG53.1\nG69\nG0 X0 Y0 Z50.")), refused);
  EXPECT_EQ(refusal_of(program_of("G68.2 X0 Y0 Z0 I0 J90. K0\nG0 A90. C0\nG0 X0 Y0 Z50."), options), "taken");
  EXPECT_EQ(refusal_of(program_of("G0 A90. C0\nG43.4\nG0 X0 Y0 Z50."), options), "taken");
  EXPECT_EQ(
      refusal_of(program_of("G68.2 X0 Y0 Z0 I0 J90. K0\nG53.1\nG69\nG91 G28 Z0\nG90 G0 A0. C0\nX0 Y0 Z50."), options),
      "taken")
      << "the ways out of it";
}

TEST(FanucTilt, LeavesTheMachinesAxesAsTheyLieWhereTheToolTurned) {
  Options options;
  options.rotary = {{'C', 1}, {'A', 1}};
  options.reference_mm = {{0, 0, 200}};
  const std::string tilted = "G68.2 X0 Y0 Z0 I0 J30. K0\nG53.1\nG0 X0 Y0 Z50.\nG69\n";
  for (const char* up : {"G91 G28 Z0", "G0 G53 Z0"}) {
    const auto end = ends_of(tilted + up, options).back();
    EXPECT_THAT(end, near(0, -25, 200)) << up;
    EXPECT_THAT(refusal_of(program_of(tilted + up), {.reference_mm = options.reference_mm}),
                HasSubstr("give --rotary C,A"))
        << "along the tool, where it is the table that turned: " << up;
  }
}

TEST(FanucTilt, TakesTheMachinesAxesAlongWhereATableTurned) {
  Options options;
  options.rotary = {{'C', 1, {{0, 0, -20}}}, {'A', 1, {{0, 0, -20}}}};
  options.reference_mm = {{0, 0, 200}};
  const std::string tilted = "G68.2 X0 Y0 Z0 I0 J30. K0\nG53.1\nG0 X0 Y0 Z50.\nG69\nG91 G28 Z0";
  // Up along the tool, to 220 above the axes that are 20 below the part's zero.
  const double up = 220 - 20 * std::cos(std::numbers::pi / 6);
  EXPECT_THAT(ends_of("G0 A30. C0\n" + tilted, options).back(), near(0, -up / 2, up * std::cos(std::numbers::pi / 6)));
  const auto refused = HasSubstr("how the machine's axes lie to the part is not known here; write A, B and C before");
  EXPECT_THAT(refusal_of(program_of(tilted), options), refused) << "what G53.1 turned them to only the machine knows";
  options.rotary[1].sign = -1;
  EXPECT_THAT(refusal_of(program_of("G0 A30. C0\n" + tilted), options), refused) << "the other sense than the post's";
}

TEST(FanucTilt, TakesTheMachinesZAloneAlongATurnedTableBelowATiltedHead) {
  Options options;
  options.rotary = {{'C', 1, {{0, 0, 0}}}, {'B', 1}};
  options.reference_mm = {{0, 0, 200}};
  const std::string tilted = "G43.4\nG0 X10. Y0 Z50. B30. C90.\nG49\nG91 ";
  EXPECT_THAT(ends_of(tilted + "G28 Z0", options).back(), near(10, 0, 200));
  EXPECT_THAT(refusal_of(program_of(tilted + "G28 X0"), options), HasSubstr("a table is turned below a tilted tool"));
}

TEST(FanucTilt, TakesATableThatMadeWholeTurnsAsOneThatStands) {
  Options options;
  options.rotary = {{'C', 1, {{0, 0, 0}}}, {'B', 1}};
  options.reference_mm = {{0, 0, 200}};
  const auto retracted = [](int turns) {
    return fmt::format("G43.4\nG0 X10. Y0 Z50. B30. C{}.\nG49\nG91 G28 X0 Z0", turns * 360);
  };
  const auto end = ends_of(retracted(0), options).back();
  for (const int turns : {-2, -1, 1, 3}) EXPECT_EQ(ends_of(retracted(turns), options).back(), end) << turns;
  EXPECT_THAT(refusal_of(program_of("G43.4\nG0 X10. Y0 Z50. B30. C361.\nG49\nG91 G28 X0"), options),
              HasSubstr("a table is turned below a tilted tool"));
}

TEST(FanucTilt, LeavesUnknownHowTheMachinesAxesLieWhereATableWentToItsReference) {
  Options options;
  options.rotary = {{'C', 1, {{0, 0, -20}}}, {'A', 1, {{0, 0, -20}}}};
  options.reference_mm = options.second_reference_mm = {{0, 0, 200}};
  const std::string tilted = "G0 A30. C0\nG91 ";
  for (const char* up : {"G28 Z0", "G30 Z0", "G28 X0 Y0 Z0", "G90 G53 Z0"}) {
    EXPECT_THAT(
        refusal_of(program_of(tilted + "G28 A0\n" + up), options),
        testing::AllOf(StartsWith("7:"), HasSubstr("where axis A stands behind G28 is not known here; write A")))
        << "it would go along the table as it was tilted before: " << up;
    EXPECT_EQ(refusal_of(program_of(tilted + "G28 A0\nG90 G0 A0 C0\nG91\n" + up), options), "taken") << up;
  }
  EXPECT_EQ(refusal_of(program_of(tilted + "G28 Z0\nG28 A0"), options), "taken") << "up before it turns";
  EXPECT_EQ(ends_of(tilted + "G28 Z0 A0", options), ends_of(tilted + "G28 Z0", options)) << "up while it turns";
}

TEST(FanucToolAxis, StandsWhereNobodyKnowsBehindG28) {
  Options options;
  options.rotary = {{'A', 1}};
  options.reference_mm = {{100, 0, 200}};
  EXPECT_THAT(ends_of("G0 A0.\nG91 G28 Z0. A0.\nG28 X0.\nG90 G0 X1. A0.", options),
              ElementsAre(near(0, 0, 200), near(100, 0, 200), near(1, 0, 200)))
      << "as Mastercam ends an operation, and begins the next one";
  EXPECT_THAT(refusal_of(program_of("G91 G28 Z0. A0.\nG90 G0 X1."), options),
              StartsWith("6:5: where axis A stands behind G28 is not known here; write A"));
  EXPECT_THAT(refusal_of(program_of("G91 G28 A0.\nA5."), options), HasSubstr("write its angle under G90 first"));
  EXPECT_THAT(refusal_of(program_of("G91 G30 A0."), options), testing::Not("taken"));
  EXPECT_THAT(refusal_of(program_of("G41 D1 X9. Y9.\nA5."), {.tool_diameters_mm = {{1, 2}}, .rotary = {{'A', 1}}}),
              HasSubstr("cutter radius compensation is on"));
}

TEST(FanucToolAxis, OfVectorsIsTheirDirection) {
  const auto moves =
      legacy::moves_in(imported(program_of("G43.5\nG1 X1. I3. J0 K4.\nG0 X2. I0 J0 K1.\nG2 X4. Y0 I1. J0")));
  EXPECT_THAT(axis_at_end(moves[0]), near(0.6, 0, 0.8));
  EXPECT_THAT(axis_at_end(moves[1]), near(0, 0, 1));
  EXPECT_EQ(moves[2]["method"], "RMAC_CAM.MoveAlongArc");
  EXPECT_THAT(refusal_of(program_of("G43.5\nG1 X1. I0 J0 K0")), HasSubstr("no direction"));
  EXPECT_THAT(refusal_of(program_of("G1 X1. I3. J0 K4.")), HasSubstr("nothing in this block uses I"));
}

}  // namespace
}  // namespace rmac::fanuc
