// Programs for machines whose fourth axis turns the part, as posts write them: X, Y and Z are those of the machine.
#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using nlohmann::json;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A turns the part about X, 10 mm below the program's zero.
Options a_table() {
  Options options;
  options.rotary = {{'A', 1, {{0, 0, -10}}}};
  options.reference_mm = {{0, 0, 200}};
  return options;
}

/// That goes on beyond half a turn.
Options a_wound_table() {
  Options options = a_table();
  options.rotary_way = gcode::RotaryWay::Written;
  return options;
}

auto is_near(double x, double y, double z) {
  return ElementsAre(DoubleNear(x, 1e-6), DoubleNear(y, 1e-6), DoubleNear(z, 1e-6));
}

std::vector<json> params_of(const std::string& lines, const std::string& method, const Options& options) {
  std::vector<json> found;
  for (const auto& request : imported(program_of(lines), options).requests) {
    if (request["method"] == "RMAC_CAM." + method) found.push_back(request["params"]);
  }
  return found;
}

/// That the move of the last line has.
double feed_of(const std::string& lines, const Options& options) {
  return params_of(lines, "SetFeedrate", options).back()["Feedrate"].get<double>();
}

TEST(FanucTurntable, LeavesXYZToTheMachineAndTurnsThePart) {
  EXPECT_THAT(ends_of("G0 A90.\nX3. Y4. Z5.\nG1 Z0.", a_table()),
              ElementsAre(is_near(0, -20, -10), is_near(3, -15, -6), is_near(3, -10, -6)));
  const auto index = imported(program_of("G0 A90."), a_table()).requests.back();
  EXPECT_EQ(index["method"], "RMAC_CAM.MoveAlongArc") << "an index goes round the part, not through it";
  EXPECT_EQ(index["params"]["CenterPoint"], json({{"p", {0, 0, -10}}, {"axis", {1, 0, 0}}}));
  EXPECT_EQ(index["params"]["RotSign"], 1);
  EXPECT_EQ(index["params"]["EndPoint"]["axis"], json({0, -1, 0}));
}

TEST(FanucTurntable, OfTheOtherSenseTurnsTheOtherWay) {
  Options options = a_table();
  options.rotary[0].sign = -1;
  EXPECT_THAT(ends_of("G0 A90.\nZ0.", options), ElementsAre(is_near(0, 20, -10), is_near(0, 10, -10)));
}

TEST(FanucTurntable, KeepsArcsWholeAndCyclesAndContoursAlongItsTool) {
  const auto arc = params_of("G0 A90.\nG3 X10. I5. Z0.", "MoveAlongArc", a_table()).back();
  EXPECT_EQ(arc["CenterPoint"], json({{"p", {5, -20, -10}}, {"axis", {0, -1, 0}}}));
  EXPECT_EQ(arc["EndPoint"]["p"], json({10, -10, -10}));
  EXPECT_THAT(ends_of("G0 A-90.\nG98 G81 X1. Y2. Z-3. R1.\nG80", a_table()),
              ElementsAre(is_near(0, 20, -10), is_near(1, 20, -12), is_near(1, 11, -12), is_near(1, 7, -12),
                          is_near(1, 20, -12)));
  Options options = a_table();
  options.tool_diameters_mm = {{1, 4}};
  EXPECT_THAT(ends_of("G0 A90.\nG1 G41 D1 X10. Y0\nG1 X20.\nG40 G1 X30. Y9.", options),
              ElementsAre(is_near(0, -20, -10), is_near(10, -20, -8), is_near(20, -20, -8), is_near(30, -20, -1)));
}

TEST(FanucTurntable, TurnsWhileTheToolMoves) {
  const std::string wrap = "G1 Z0 F1000.\nX30. A360.";
  const auto helix = params_of(wrap, "MoveAlongArc", a_wound_table());
  ASSERT_EQ(helix.size(), 3U);
  EXPECT_EQ(helix[0]["EndPoint"]["p"], json({10, -8.660254, -15}));
  EXPECT_EQ(helix[2]["EndPoint"], json({{"p", {30, 0, 0}}, {"axis", {0, 0, 1}}}));
  const auto spiral = params_of("G1 Z0 Y5. A90.", "MoveAlongNurbsND", a_table());
  ASSERT_EQ(spiral.size(), 1U);
  EXPECT_EQ(spiral[0]["NurbsND"]["space"], "pose");
  EXPECT_EQ(spiral[0]["NurbsND"]["points"].front(), json({0, 0, 10, 0, 0, 1}));
  EXPECT_EQ(spiral[0]["NurbsND"]["points"].back(), json({0, -10, -5, 0, -1, 0}));
  EXPECT_EQ(params_of("G0 X9. Y9. Z9. A9.", "MoveAlongNurbsND", a_table()).size(), 1U) << "rapids go as evenly";
}

TEST(FanucTurntable, CountsDegreesAsMillimetresInItsFeed) {
  // sqrt(30² + 360²) / 1000 minutes for 2 pi 10 and 30 mm.
  EXPECT_NEAR(feed_of("G1 Z0 F1000.\nX30. A360.", a_wound_table()), std::hypot(20 * M_PI, 30) / std::hypot(0.03, 0.36),
              1e-6);
  EXPECT_NEAR(feed_of("G1 Z0 F360.\nA-360.", a_wound_table()), 2 * M_PI * 10, 1e-6);
  EXPECT_NEAR(feed_of("G20\nG1 Z0 F10.\nA-90.", a_wound_table()), M_PI * 10 / 2 / 9, 1e-6);
  Options options = a_wound_table();
  options.rotary_diameter_mm = 20;
  EXPECT_NEAR(feed_of("G1 Z0 F500.\nA-360.", options), 500, 1e-6) << "as a Haas has it";
  EXPECT_NEAR(feed_of("G1 Z-10. F90.\nA-100.", a_wound_table()), 90, 1e-9) << "a tip on the axis turns by degrees";
}

TEST(FanucTurntable, GoesMoreThanHalfATurnOnlyAsItIsToldTo) {
  EXPECT_THAT(refusal_of(program_of("A10.\nG0 A300."), a_table()),
              StartsWith("6:4: from A10 that is more than half a turn"));
  EXPECT_EQ(refusal_of(program_of("A10.\nG91 A-300."), a_table()), "taken");
  Options options = a_wound_table();
  options.rotary_way = gcode::RotaryWay::Shorter;
  EXPECT_EQ(params_of("A10.\nG0 A300.", "MoveAlongArc", options).back()["RotSign"], -1);
  EXPECT_EQ(params_of("A10.\nG0 A300.\nA0.", "MoveAlongArc", options).back()["RotSign"], 1);
  options.rotary_way = gcode::RotaryWay::Written;
  EXPECT_EQ(params_of("A10.\nG0 A300.", "MoveAlongArc", options).back()["RotSign"], 1);
  EXPECT_EQ(params_of("A10.\nG0 A300.\nA-300000.", "MoveAlongArc", options).size(), 1U + 3 + 2503);
  EXPECT_THAT(refusal_of(program_of("G0 A361000."), a_wound_table()), HasSubstr("more than 1000 turns"));
}

TEST(FanucTurntable, ComesToItsFirstAngleByAllJointsTogether) {
  const std::string program = "G21 G90\nG0 X1. Y2. Z30. A90.\nG1 Z0 F100.\nM30\n";
  const auto first = imported("O1\n" + program, a_table()).requests[0];
  EXPECT_EQ(first["method"], "RMAC_CAM.MoveToJointTarget");
  EXPECT_EQ(first["params"]["JointTargetFrame"], json({{"p", {1, -40, -8}}, {"axis", {0, -1, 0}}}));
}

TEST(FanucTurntable, IsApproachedWhereTheTableHasThePart) {
  Options options = a_table();
  options.approach_mm = {{0, 0, 90}};
  const auto requests = imported("O1\nG21 G90 G54\nG0 X1. Y2. A90.\nZ5.\nM30\n", options).requests;
  EXPECT_EQ(requests[0]["params"]["JointTargetFrame"]["p"], json({0, -100, -10}));
  EXPECT_EQ(requests[1]["params"]["TargetFrame"]["p"], json({1, -100, -8}));
}

TEST(FanucTurntable, RetractsAlongTheToolBetweenIndexes) {
  EXPECT_THAT(ends_of("A90.\nG91 G28 Z0\nG90\nG0 G53 Z0\nA180.", a_table()),
              ElementsAre(is_near(0, -20, -10), is_near(0, -210, -10), is_near(0, 0, -220)));
  const auto back = imported(program_of("A90.\nG91 G28 Z0 A0\nG90\nA90.\nX5."), a_table()).requests;
  EXPECT_EQ(back[3]["method"], "RMAC_CAM.MoveToJointTarget") << "nobody knows how far it was";
  EXPECT_EQ(back[3]["params"]["JointTargetFrame"]["p"], json({0, -210, -10}));
  EXPECT_THAT(refusal_of(program_of("A90.\nG28 W0 A0\nG1 A90."), a_table()),
              StartsWith("7:4: where the table stands before this is not known"));
  EXPECT_THAT(refusal_of(program_of("A90.\nG28 W0 A0\nX5."), a_table()), HasSubstr("stands behind G28 is not known"));
}

TEST(FanucTurntable, DrillsAHoleAtEachAngle) {
  // R is 10 mm from the axis, and so is the hole of each angle.
  EXPECT_THAT(ends_of("G99 G81 X5. Z-3. R0.\nA90.\nG91 A90.\nG80", a_table()),
              ElementsAre(is_near(5, 0, 10), is_near(5, 0, 0), is_near(5, 0, -3), is_near(5, 0, 0),  //
                          is_near(5, -10, -10), is_near(5, -7, -10), is_near(5, -10, -10),           //
                          is_near(5, 0, -20), is_near(5, 0, -17), is_near(5, 0, -20)));
  EXPECT_THAT(refusal_of(program_of("A0\nG91 G81 X5. A10. Z-3. R0. K3"), a_table()),
              HasSubstr("each hole with its angle"));
}

TEST(FanucTurntable, StaysWhereItIsInTheMachineInAnotherWorkSystem) {
  Options options = a_table();
  options.offsets[0] = {0, 0, 0};
  options.offsets[1] = {7, 2, 3};
  // Of the machine 0 4 5; of G54's part 0 -15 -6, and G55's is shifted by what the frame is.
  EXPECT_THAT(ends_of("A90.\nG55\nG0 X-7. Y2. Z2.", options).back(), is_near(-7, -17, -9));
  EXPECT_THAT(ends_of("G55\nA90.\nG0 X-7. Y2. Z2.", options).back(), is_near(-7, -17, -9));
  EXPECT_THAT(ends_of("A90.\nG52 Y1.\nG0 Y3. Z5.", options).back(), is_near(0, -15, -6));
  EXPECT_THAT(ends_of("A90.\nG92 Y1.\nG0 Y5. Z5.", options).back(), is_near(0, -15, -6));
  EXPECT_THAT(refusal_of(program_of("G10 L2 P1 X0 Y5. Z0\nG0 X0 Y0 Z0\nA90."), a_table()),
              StartsWith("7:1: --rotary-centre is in the coordinates of the begin"));
}

TEST(FanucTurntable, EndsWhereThePartIsToldOtherwise) {
  Options options = a_table();
  options.assume_g43 = true;
  EXPECT_THAT(ends_of("A90.\nG43.4\nG0 X3. Y-15. Z-6.\nG49\nG0 X3. Y4. Z9.", options),
              ElementsAre(is_near(0, -20, -10), is_near(3, -15, -6), is_near(3, -19, -6)));
  EXPECT_THAT(ends_of("A90.\nG68 X0 Y0 R90.\nG0 X4. Y-3. Z5.\nG69\nX3. Y4.", options).back(), is_near(3, -15, -6));
}

TEST(FanucTurntable, HasAnglesOnItsArcsAndSplinesRefused) {
  EXPECT_THAT(refusal_of(program_of("G2 X10. I5. A9."), a_table()), HasSubstr("is a G0 or G1"));
  EXPECT_THAT(refusal_of(program_of("G0 G53 Z0 A9."), a_table()), HasSubstr("a block of its own"));
  EXPECT_THAT(refusal_of(program_of("G80 A9."), {.rotary = {{'A', 1}}}), "taken");
}

TEST(FanucTurntable, TurnsBesideG80ByWhatWasInForceBeforeTheCycle) {
  EXPECT_THAT(ends_of("G99 G81 X5. Z-3. R0.\nG80 A90.", a_table()).back(), is_near(5, -10, -10)) << "by G0";
  const auto fed = imported(program_of("G1 X1. F360.\nG80 A90."), a_table()).requests.back();
  EXPECT_EQ(fed["params"]["EndPoint"]["p"], json({1, -20, -10})) << "by G1";
}

TEST(FanucTurntable, HasAnglesUnderVectorsRefused) {
  EXPECT_THAT(refusal_of(program_of("G43.5\nG0 A90.\nX3. Y4. Z5."), a_table()), StartsWith("6:4: under G43.5 I, J"));
  EXPECT_THAT(refusal_of(program_of("G43.5\nG0 A90. X3."), a_table()), StartsWith("6:4: under G43.5 I, J"));
  EXPECT_EQ(refusal_of(program_of("G43.5\nG0 A0\nX3. Y4. Z5."), a_table()), "taken");
}

TEST(FanucTurntable, SaysWhereTheTipHardlyMovesWhileItTurns) {
  EXPECT_THAT(refusal_of(program_of("G1 Z-10. Y0.01\nF1. A90."), a_table()),
              StartsWith("6:1: the tip hardly moves while the table turns"));
  EXPECT_EQ(refusal_of(program_of("G1 Z-10. Y0.01\nG0 A90."), a_table()), "taken");
  EXPECT_THAT(refusal_of(program_of("F0.001 G1 A90."), a_table()), HasSubstr("feed is not within"));
}

TEST(FanucTurntable, OfTwoAxesTurnsBothAboutTheirCentres) {
  Options options;
  options.rotary = {{'C', 1, {{10, 0, 0}}}, {'A', 1, {{0, 0, -10}}}};
  // A: 12 5 -> 12 -15 -5; C a quarter about 10 0.
  EXPECT_THAT(ends_of("G0 A90. C90.\nX12. Y5. Z5.", options).back(), is_near(25, 2, -5));
  EXPECT_EQ(params_of("G1 Z5. A90. C90.", "MoveAlongNurbsND", options).size(), 1U);
  EXPECT_THAT(refusal_of(program_of("G1 X10. Z-10.\nA30. C0\nC90."), options), StartsWith("7:1: the tip stands on"));
  options.rotary[1].centre_mm.reset();
  EXPECT_THAT(ends_of("G0 C90. A0\nX12. Y5. Z5.", options).back(), is_near(5, 2, 5));
  EXPECT_THAT(refusal_of(program_of("G0 C90. A9.\nX12. Y5. Z5."), options), HasSubstr("give --rotary-centre"));
}

}  // namespace
}  // namespace rmac::fanuc
