#include <fmt/format.h>
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

json calls_of(const json& request) {
  return request["params"]["Calls"];
}

TEST(Rs274Machine, SwitchesSpindleAndCoolantInTurnOfTheMoves) {
  const auto done = imported(program_of("M3 S1000 M8\nG1 X1\nS500\nM5 M9"));
  EXPECT_THAT(done.methods,
              ElementsAre("MoveToPathTarget", "InTurn", "SetFeedrate", "MoveAlongLine", "InTurn", "InTurn"));
  EXPECT_EQ(calls_of(done.requests[1])[0]["params"], json({{"SpindleNumber", 0}, {"RPM", 1000}}));
  EXPECT_EQ(calls_of(done.requests[1])[1]["method"], "RMAC_CAM.TurnCoolantOn");
  EXPECT_EQ(calls_of(done.requests[4])[0]["params"]["RPM"], 500);
  EXPECT_EQ(calls_of(done.requests[5])[1]["method"], "RMAC_CAM.TurnCoolantOff");
  EXPECT_EQ(calls_of(imported(program_of("M4 S7")).requests[1])[0]["params"]["RPM"], -7);
  EXPECT_EQ(calls_of(imported(program_of("M7")).requests[1])[0]["params"], json({{"Name", "Mist"}, {"On", true}}));
}

/// The table of the report: the spindle before the dwell before the move before the stop, wherever they stand.
TEST(Rs274Machine, KeepsTheOrderWithinABlock) {
  EXPECT_THAT(
      imported(program_of("M0 G1 X1 G4 P2 M3 S9")).methods,
      ElementsAre("MoveToPathTarget", "InTurn", "Dwell", "SetFeedrate", "MoveAlongLine", "ProgramStop", "InTurn"));
}

TEST(Rs274Machine, SwitchesAllOffAtTheEnd) {
  const auto done = imported(program_of("M3 S9 M8"));
  EXPECT_EQ(done.methods.back(), "InTurn");
  EXPECT_EQ(calls_of(done.requests.back()).size(), 2U);
}

TEST(Rs274Machine, SwitchesAllOffAtTheSecondPercentSign) {
  const auto done = imported("%\nG21 G0 X0 Y0 Z0\nM3 S9 M8\n%\n");
  EXPECT_EQ(done.methods.back(), "InTurn");
  EXPECT_EQ(calls_of(done.requests.back()).size(), 2U);
  EXPECT_EQ(done.requests.size(), 3U);
}

TEST(Rs274Machine, TellsAPersonWhyItStops) {
  EXPECT_EQ(imported(program_of("M0 (turn the \"part\")")).requests[1]["params"]["Message"], "turn the \"part\"");
  EXPECT_EQ(imported(program_of("(MSG, look)\nM1")).requests[1]["params"],
            json({{"MoveID", 4}, {"Optional", true}, {"Message", "look"}}));
}

TEST(Rs274Tool, IsChangedAndTheNextMoveNamesItsWholePlace) {
  const auto done = imported(program_of("T3 M6\nG43 H3\nG0 X0 Y0 Z50"));
  EXPECT_THAT(done.methods, ElementsAre("MoveToPathTarget", "DoToolChange", "MoveToPathTarget"));
  EXPECT_EQ(done.requests[1]["params"]["ToolNumber"], 3);
  EXPECT_THAT(refusal_of(program_of("T3 M6\nG43\nG0 X0 Y0")),
              StartsWith("5:1: where the tool is before this move is not known"));
  EXPECT_THAT(refusal_of(program_of("M6")), HasSubstr("without a T"));
}

TEST(Rs274Tool, HasTheCoolantFlowOnBehindItsChange) {
  EXPECT_THAT(imported(program_of("M8\nT3 M6\nG43")).methods,
              ElementsAre("MoveToPathTarget", "InTurn", "DoToolChange", "InTurn", "InTurn"));
}

TEST(Rs274Tool, HasALengthThatCounts) {
  EXPECT_THAT(refusal_of(program_of("T3 M6\nG0 X0 Y0 Z50")),
              StartsWith("4:1: Z of a tool whose length does not count"));
  EXPECT_EQ(imported(program_of("T3 M6\nG0 X0 Y0 Z50"), {.assume_g43 = true}).requests.size(), 3U);
  EXPECT_THAT(refusal_of(program_of("G49 G0 Z9")), HasSubstr("does not count"));
  EXPECT_EQ(ends_of("G49 G0 X9").size(), 1U);  // X is X, whatever the length
  EXPECT_THAT(refusal_of(program_of("T3 M6\nG43 H4")), StartsWith("4:5: the length of another tool"));
  EXPECT_THAT(refusal_of(program_of("G43 H4")), HasSubstr("write T4 M6 before it"));
}

TEST(Rs274Control, SetsThePathToleranceThatItSays) {
  EXPECT_EQ(imported(program_of("G64 P0.05")).requests[1]["params"]["Tolerance"], 0.05);
  EXPECT_EQ(imported(program_of("G20\nG64 P0.001 Q0.001")).requests[1]["params"]["Tolerance"], 0.0254);
  EXPECT_EQ(imported(program_of("G61")).requests[1]["params"]["Tolerance"], 0);
  EXPECT_THAT(refusal_of(program_of("G64")), HasSubstr("give --tolerance"));
  EXPECT_EQ(imported(program_of("G64"), {.tolerance_mm = 0.2}).requests[1]["params"]["Tolerance"], 0.2);
}

TEST(Rs274Offset, OfG92ShiftsWhatCoordinatesMean) {
  EXPECT_THAT(ends_of("G92 X5\nG0 X6"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(ends_of("G92 X5\nG92.1\nG0 X6"), ElementsAre(ElementsAre(6, 0, 10)));
  EXPECT_THAT(ends_of("G92 X5\nG92.2\nG0 X6\nG92.3 X6"), ElementsAre(ElementsAre(6, 0, 10), ElementsAre(1, 0, 10)));
  EXPECT_THAT(refusal_of("G21 G92 X5\nM2\n"), HasSubstr("not known"));
}

TEST(Rs274Offset, OfG52IsAbsoluteAndStandsWhereThatOfG92Does) {
  EXPECT_THAT(ends_of("G52 X1 Y2\nG0 X6 Y0"), ElementsAre(ElementsAre(7, 2, 10)));
  EXPECT_THAT(ends_of("G52 X1 Y2\nG52 X3\nG0 X6 Y0"), ElementsAre(ElementsAre(9, 2, 10))) << "Y keeps its own";
  EXPECT_THAT(ends_of("G91 G52 X1\nG52 X1\nG90 G0 X6"), ElementsAre(ElementsAre(7, 0, 10))) << "under G91 too";
  EXPECT_THAT(ends_of("G20 G52 X1\nG21 G0 X6"), ElementsAre(ElementsAre(31.4, 0, 10)));
  EXPECT_THAT(ends_of("G92 X5\nG52 X1\nG0 X6"), ElementsAre(ElementsAre(7, 0, 10))) << "in the place of G92's";
  EXPECT_THAT(ends_of("G52 X1\nG92 X5\nG0 X6"), ElementsAre(ElementsAre(1, 0, 10)));
  for (const char* end : {"G52 X0", "G92.1", "G92.2"})
    EXPECT_THAT(ends_of(fmt::format("G52 X1\n{}\nG0 X6", end)), ElementsAre(ElementsAre(6, 0, 10))) << end;
  EXPECT_THAT(ends_of("G52 X1\nG92.2\nG92.3\nG0 X6"), ElementsAre(ElementsAre(7, 0, 10)));
}

TEST(Rs274Offset, UsesAxisWordsThatNoMotionBesideItHas) {
  for (const char* setter : {"G10 L2 P1", "G52", "G92"}) {
    for (const char* motion : {"G0", "G1", "G2", "G81"})
      EXPECT_THAT(refusal_of(program_of(fmt::format("{} {} X1 F100", motion, setter))),
                  HasSubstr("would both use the axis words; write two blocks"))
          << motion << " " << setter;
    EXPECT_THAT(ends_of(fmt::format("G1 X2\n{} X1 Y0 Z0", setter)), testing::SizeIs(1))
        << "no motion of its own: " << setter;
  }
}

TEST(Rs274Offset, OfAWorkSystemIsThePartFrame) {
  const auto done = imported(program_of("G10 L2 P1 X100 Y0 Z-50\nG10 L2 P2 X200 Y0 Z-50\nG0 X0 Y0 Z0\nG55 X1"));
  EXPECT_THAT(done.methods,
              ElementsAre("MoveToPathTarget", "SetPartFrame", "MoveToPathTarget", "SetPartFrame", "MoveToPathTarget"));
  EXPECT_EQ(done.requests[1]["params"]["PartFrame"], json({{"p", {100, 0, -50}}, {"q", {1, 0, 0, 0}}}));
  EXPECT_EQ(done.requests[3]["params"]["PartFrame"]["p"], json({200, 0, -50}));
  EXPECT_EQ(done.requests[4]["params"]["TargetFrame"]["p"], json({1, 0, 0}));
}

TEST(Rs274Offset, IsRefusedWhereItIsNotKnown) {
  EXPECT_EQ(imported(program_of("G54 G0 X1")).requests.size(), 2U);  // the part frame in force
  EXPECT_THAT(refusal_of(program_of("G55")), StartsWith("3:1: where G55 is in the machine is not known here"));
  EXPECT_THAT(refusal_of(program_of("G10 L2 P1 X5")), HasSubstr("only a part is set"));
  EXPECT_THAT(refusal_of(program_of("G10 L20 P1 X5")), HasSubstr("not known"));
  EXPECT_THAT(refusal_of(program_of("G53 G0 X1")), HasSubstr("give --offset"));
}

TEST(Rs274Offset, IsWhereWhoImportsSaysIt) {
  Options options;
  options.offsets[0] = {10, 20, 30};
  options.offsets[1] = {15, 20, 30};
  EXPECT_THAT(ends_of("G53 G0 X0 Y0", options), ElementsAre(ElementsAre(-10, -20, 10)));
  EXPECT_THAT(ends_of("G55 G0 Y1", options), ElementsAre(ElementsAre(-5, 1, 10)));  // the tool stayed where it was
  EXPECT_THAT(ends_of("G10 L20 P1 X3\nG0 Y1", options), ElementsAre(ElementsAre(3, 1, 10)));
  EXPECT_THAT(refusal_of(program_of("G53 G0 Z0"), options), HasSubstr("without its tool"));
}

TEST(Rs274Machine, KeepsOverridesWhereTheOperatorHasThem) {
  EXPECT_THAT(ends_of("M48\nM50\nM51 P1\nM53 P1\nM52 P0\nG0 X1"), ElementsAre(ElementsAre(1, 0, 10)));
  for (const char* code : {"M49", "M50 P0", "M51 P0", "M52", "M52 P1", "M53 P0"})
    EXPECT_THAT(refusal_of(program_of(code)), HasSubstr("overrides belong to the operator")) << code;
}

}  // namespace
}  // namespace rmac::rs274
