#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(FanucDwell, IsInMillisecondsWithoutAPointAndInSecondsWithOne) {
  const auto time = [](const std::string& line) { return imported(program_of(line)).requests[1]["params"]["Time"]; };
  EXPECT_EQ(time("G4 P1500"), 1.5);
  EXPECT_EQ(time("G04 X2.5"), 2.5);
  EXPECT_EQ(time("G4 U.25"), 0.25);
  EXPECT_EQ(time("G4 P0.5"), 0.5);  // Haas
  EXPECT_EQ(time("#1=250\nG4 P#1"), 0.25);
  EXPECT_THAT(refusal_of(program_of("G4 X2")), HasSubstr("no decimal point"));
  EXPECT_THAT(refusal_of(program_of("#1=2.5\nG4 P#1")), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal_of(program_of("G4 X1. P5")), HasSubstr("one time"));
}

TEST(FanucReference, IsWhereWhoImportsSaysIt) {
  Options options;
  options.reference_mm = {{100, 200, 300}};
  options.second_reference_mm = {{1, 2, 3}};
  EXPECT_THAT(ends_of("G91 G28 Z0.\nG90", options), ElementsAre(ElementsAre(0, 0, 300)));
  EXPECT_THAT(ends_of("G28 U0 V0 W0", options), ElementsAre(ElementsAre(100, 200, 300)));
  EXPECT_THAT(ends_of("G28 G91 X0 Y0 Z5.", options), ElementsAre(ElementsAre(0, 0, 15), ElementsAre(100, 200, 300)));
  EXPECT_THAT(ends_of("G30 P2 W0.", options), ElementsAre(ElementsAre(0, 0, 3)));
  EXPECT_THAT(ends_of("G0 G53 Z0.\nG53 X0 Y0", options),
              ElementsAre(ElementsAre(0, 0, 300), ElementsAre(100, 200, 300)));
  EXPECT_THAT(ends_of("G91 G28 X0. Y0. A0.", options), ElementsAre(ElementsAre(100, 200, 10)));
  EXPECT_THAT(ends_of("G91 G28 A0.", options), ElementsAre());
  options.rotary = {{'A', 1}};
  EXPECT_THAT(ends_of("G91 G28 A0.", options), ElementsAre());
  EXPECT_THAT(refusal_of(program_of("G28"), options), HasSubstr("needs X, Y or Z"));
  EXPECT_THAT(refusal_of(program_of("G30 P3 Z0"), options), HasSubstr("P2"));
  EXPECT_THAT(refusal_of(program_of("G91 G28 Z0.")), HasSubstr("give --reference-point"));
  EXPECT_THAT(refusal_of(program_of("G0 G53 Z0.")), HasSubstr("give --reference-point"));
  EXPECT_THAT(refusal_of(program_of("G0 G53 Z-5."), options), HasSubstr("not known"));
  EXPECT_THAT(refusal_of(program_of("G1 G53 Z0."), options), HasSubstr("G53 goes with G0"));
}

TEST(FanucArc, OfANegativeRadiusIsTheLongerOne) {
  const auto centre = [](const std::string& line) {
    return imported(program_of(line)).requests.back()["params"]["CenterPoint"]["p"];
  };
  EXPECT_EQ(centre("G2 X10. Y10. R10."), json({10, 0, 10}));
  EXPECT_EQ(centre("G2 X10. Y10. R-10."), json({0, 10, 10}));
  EXPECT_THAT(refusal_of(program_of("G2 X0 Y0 R5.")), HasSubstr("5:"));
}

TEST(FanucArc, IsWholeWhereOnlyItsCentreIsWritten) {
  const auto arc = imported(program_of("G1 Z0.\nG17 G3 X0 I5.")).requests.back()["params"];
  EXPECT_EQ(arc["Closed"], true);
  EXPECT_EQ(arc["CenterPoint"]["p"], json({5, 0, 0}));
  EXPECT_THAT(refusal_of(program_of("G2 X1. I.5 P2")), HasSubstr("nothing in this block uses P"));
}

TEST(FanucTool, LengthIsThatOfTheToolInTheSpindle) {
  EXPECT_EQ(imported(program_of("T3 M6\nG43 H3\nG0 X0 Y0 Z50.")).requests.size(), 3U);
  EXPECT_THAT(refusal_of(program_of("T3 M6\nG43 H23 Z5.")), StartsWith("6:5: the length of another tool"));
  EXPECT_THAT(refusal_of(program_of("G44 H1")), HasSubstr("rmac tools"));
}

TEST(FanucTool, RadiusIsInTheOffsetThatDNames) {
  Options options;
  options.tool_diameters_mm = {{31, 4}};
  EXPECT_THAT(ends_of("G1 G41 D31 X10. Y0\nG1 Y20.\nG40 G1 X0.", options).back(), ElementsAre(0, 20, 10));
  EXPECT_THAT(ends_of("G1 G42 D0 X10.\nY20.\nX20.\nG40 X0.", options)[0], ElementsAre(10, 0, 10));
  EXPECT_EQ(ends_of("D31\nG1 G41 X10.\nY20.\nG40 X0.", options), ends_of("G1 G41 D31 X10.\n\nY20.\nG40 X0.", options));
  EXPECT_THAT(refusal_of(program_of("G1 G41 D1 X10."), options), HasSubstr("give --tool-diameter 1=MM"));
  EXPECT_THAT(refusal_of(program_of("G1 G41 X10."), options), HasSubstr("no D"));
}

TEST(FanucControl, TakesG64AsWhatIsInForceAnyway) {
  EXPECT_EQ(imported(program_of("G64")).requests.size(), 1U);
  EXPECT_EQ(imported(program_of("G61")).requests[1]["params"]["Tolerance"], 0);
  EXPECT_THAT(refusal_of(program_of("G61\nG64")), HasSubstr("give --tolerance"));
  EXPECT_EQ(imported(program_of("G61\nG64"), {.tolerance_mm = 0.2}).requests[2]["params"]["Tolerance"], 0.2);
}

TEST(FanucOffset, OfAFurtherWorkSystemIsThePartFrame) {
  Options options;
  options.offsets[0] = {0, 0, 0};
  options.offsets[6 + 2] = {5, 0, 0};
  EXPECT_THAT(ends_of("G54.1 P3 G0 Y1.", options), ElementsAre(ElementsAre(-5, 1, 10)));
  EXPECT_THAT(ends_of("G54 P3\nG0 Y1.", options), ElementsAre(ElementsAre(-5, 1, 10)));
  EXPECT_THAT(ends_of("G10 L20 P4 X7. Y0 Z0\nG54.1 P4\nG0 Y1.", options), ElementsAre(ElementsAre(-7, 1, 10)));
  EXPECT_THAT(refusal_of(program_of("G54.1 P9"), options),
              HasSubstr("set it by G10 L20 P9 X Y Z before, or give --offset G54.1P9"));
  EXPECT_THAT(refusal_of(program_of("G54.1"), options), HasSubstr("needs P"));
}

TEST(FanucOffset, IsSetAbsolutelyOrAddedTo) {
  Options options;
  options.offsets[0] = {0, 0, 0};
  EXPECT_THAT(ends_of("G10 L2 P1 X2. Y0 Z0\nG91 G10 L2 P1 X1.\nG90 G0 Y1.", options),
              ElementsAre(ElementsAre(-3, 1, 10)));
  EXPECT_THAT(refusal_of(program_of("G10 L2 P0 X1.")), HasSubstr("all work systems"));
  EXPECT_THAT(refusal_of(program_of("G10 L12 P1 R5.")), HasSubstr("rmac tools"));
}

TEST(FanucOffset, OfALocalSystemHoldsInAllAndEndsByG92) {
  EXPECT_THAT(ends_of("G52 X5. Y1.\nG0 X1. Y1.\nG52 X0 Y0\nG0 X1."),
              ElementsAre(ElementsAre(6, 2, 10), ElementsAre(1, 2, 10)));
  EXPECT_THAT(ends_of("G52 X5.\nG92 X0\nG0 X1.\nG92.1 X0\nG0 X2."),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(2, 0, 10)));
}

TEST(FanucOffset, UsesAxisWordsThatNoMotionBesideItHas) {
  for (const char* setter : {"G10 L2 P1", "G52", "G92"}) {
    for (const char* motion : {"G0", "G1", "G2", "G81"})
      EXPECT_THAT(refusal_of(program_of(fmt::format("{} {} X1.", motion, setter))),
                  StartsWith(fmt::format("5:1: {} and {} would both use the axis words", motion,
                                         std::string_view(setter).substr(0, 3))));
  }
}

TEST(FanucReference, IsInTheFrameOfTheBegin) {
  Options options;
  options.reference_mm = options.second_reference_mm = {{100, 200, 300}};
  options.offsets[0] = {-100, -200, 0};
  options.offsets[1] = {-90, -180, 5};
  EXPECT_THAT(ends_of("G55\nG28 U0 V0 W0", options).back(), ElementsAre(90, 180, 295));
  EXPECT_THAT(ends_of("G55\nG30 U0 V0 W0", options).back(), ElementsAre(90, 180, 295));
  EXPECT_THAT(ends_of("G55\nG0 G53 X0 Y0", options).back(), ElementsAre(90, 180, 5));
  options.offsets.clear();
  EXPECT_THAT(refusal_of(program_of("G10 L2 P1 X1. Y2. Z3.\nG0 X0 Y0 Z0\nG28 W0"), options),
              StartsWith("7:1: --reference-point"));
  EXPECT_THAT(refusal_of(program_of("G10 L2 P1 X1. Y2. Z3.\nG0 X0 Y0 Z0\nG0 G53 X0"), options),
              StartsWith("7:8: --reference-point"));
}

TEST(FanucReference, IsNoZeroWhereTheOffsetSaysAnother) {
  Options options;
  options.reference_mm = {{100, 200, 300}};
  options.offsets[0] = {-101, -200, 0};
  EXPECT_THAT(refusal_of(program_of("G0 G53 X0"), options),
              StartsWith("5:8: --offset has the machine's zero at X101, and --reference-point the reference point at "
                         "X100; write the way there"));
  EXPECT_THAT(ends_of("G0 G53 Y0", options).back(), ElementsAre(0, 200, 10));
}

TEST(FanucTool, LeavesAContourByAMoveInItsPlane) {
  Options options;
  options.tool_diameters_mm = {{31, 4}};
  const std::string contour = "G1 Z0\nG41 D31 X10. Y0\nY20.\n";
  EXPECT_THAT(refusal_of(program_of(contour + "G40\nG0 Z50."), options),
              StartsWith("9:1: write the move in X and Y that leaves the contour"));
  EXPECT_THAT(refusal_of(program_of(contour + "G40 G0 Z50."), options), StartsWith("8:5: write the move in X and Y"));
  EXPECT_THAT(ends_of(contour + "G40\nG0 X0 Z50.", options).back(), ElementsAre(0, 20, 50));
}

TEST(FanucTool, ComesToAnInsideCornerBesideTheSecondMovesBegin) {
  Options options;
  options.tool_diameters_mm = {{31, 4}};
  EXPECT_THAT(
      ends_of("G1 Z0\nG41 D31 X10. Y0\nX0 Y20.\nX-20.\nG40 Y0", options)[1],
      ElementsAre(testing::DoubleNear(10 - 4 / std::sqrt(5), 1e-6), testing::DoubleNear(-2 / std::sqrt(5), 1e-6), 0));
}

TEST(FanucSwitch, OffActsBehindTheMotionAndOnBeforeIt) {
  EXPECT_THAT(imported(program_of("G1 X1. M3 S500\nX2. M8\nX3. M9\nX4. M5")).methods,
              ElementsAre("MoveToPathTarget", "InTurn", "SetFeedrate", "MoveAlongLine", "InTurn", "MoveAlongLine",
                          "MoveAlongLine", "InTurn", "MoveAlongLine", "InTurn"));
  EXPECT_THAT(imported(program_of("M3 S500 M8\nT2 M6 M9")).methods,
              ElementsAre("MoveToPathTarget", "InTurn", "DoToolChange"))
      << "the change stopped both";
}

TEST(FanucSwitch, TurnsNoSpindleWithoutASpeed) {
  EXPECT_THAT(refusal_of(program_of("M3")), StartsWith("5:1: no S"));
  EXPECT_THAT(refusal_of(program_of("M4\nS500")), StartsWith("5:1: no S"));
  EXPECT_EQ(refusal_of(program_of("S500\nM3\nM5\nM4\nM5")), "taken");
}

TEST(FanucUnits, EndTheFeed) {
  EXPECT_THAT(refusal_of(program_of("G20\nG1 X1.")), StartsWith("6:1: no feed was set"));
  EXPECT_EQ(refusal_of(program_of("G20\nG1 X1. F10.")), "taken");
  EXPECT_EQ(refusal_of(program_of("G21\nG1 X1.")), "taken");
  EXPECT_EQ(imported(program_of("G20 G1 X1. F10.")).requests[1]["params"]["Feedrate"], 254)
      << "F beside it is the new one's";
}

}  // namespace
}  // namespace rmac::fanuc
