#include <gmock/gmock.h>

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The moves of lines that begin at 10,0,0.
std::vector<json> moves_from_ten(const std::string& lines, const Options& options = {}) {
  auto moves = moves_of("RAPID\nGOTO/10,0,0\n" + lines, options);
  if (!moves.empty()) moves.erase(moves.begin());
  return moves;
}

json arc_of(const std::string& lines, const Options& options = {}) {
  const auto moves = moves_from_ten(lines, options);
  if (moves.size() == 1 && moves[0]["method"] == "RMAC_CAM.MoveAlongArc") return moves[0]["params"];
  ADD_FAILURE() << "not one arc: " << lines;
  return {};
}

std::string refusal_from_ten(const std::string& lines, const Options& options = {}) {
  return refusal_of(program_of("RAPID\nGOTO/10,0,0\n" + lines), options);
}

const std::string kNxTail = ",10,.06,.5,10,0";

TEST(AptCatiaArc, GoesForwardToTheLineFromItsCentre) {
  const json quarter = arc_of("AUTOPS\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,$\n10),ON,(LINE/0,0,0,0,10,0)");
  EXPECT_EQ(quarter["RotSign"], 1);
  EXPECT_EQ(quarter["Closed"], false);
  EXPECT_EQ(quarter["CenterPoint"], json({{"p", {0, 0, 0}}, {"axis", {0, 0, 1}}}));
  EXPECT_EQ(quarter["EndPoint"]["p"], json({0, 10, 0}));
  EXPECT_EQ(quarter["MoveID"], 9);
  const json other_way = arc_of("INDIRV/0,-1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,2,INTOF,(LINE/0,0,0,0,10,0)");
  EXPECT_EQ(other_way["RotSign"], -1);
  EXPECT_EQ(other_way["EndPoint"]["p"], json({0, 10, 0}));
}

TEST(AptCatiaArc, IsAFullCircleWhereItsSecondMeetingIsItsStart) {
  const json circle = arc_of("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,2,INTOF,(LINE/0,0,0,10,0,0)");
  EXPECT_EQ(circle["Closed"], true);
  EXPECT_EQ(circle["EndPoint"]["p"], json({10, 0, 0}));
}

TEST(AptCatiaArc, AboutAnAxisOfItsOwnIsACylinder) {
  const json arc = arc_of(
      "PSIS/(PLANE/(POINT/10,0,0),PERPTO,$\n(VECTOR/0,1,0))\nINDIRV/0,0,1\nTLON,GOFWD/(CYLNDR/0,0,0,$\n0,1,0,10),ON,$\n"
      "(PLANE/PERPTO,$\n(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,1,0)),$\n(POINT/0,0,0),(POINT/0,0,10))");
  EXPECT_EQ(arc["RotSign"], -1);
  EXPECT_EQ(arc["CenterPoint"], json({{"p", {0, 0, 0}}, {"axis", {0, 1, 0}}}));
  EXPECT_EQ(arc["EndPoint"]["p"], json({0, 0, 10}));
  EXPECT_THAT(refusal_from_ten("PSIS/(PLANE/(POINT/10,0,0),PERPTO,(VECTOR/0,0,1))\nINDIRV/0,0,1\n"
                               "TLON,GOFWD/(CYLNDR/0,0,0,0,1,0,10),ON,(LINE/0,0,0,0,0,10)"),
              StartsWith("9:12: the plane of PSIS"));
}

TEST(AptCatiaArc, ThatContradictsItselfIsRefused) {
  const auto refusal = [](const std::string& direction, const std::string& rest) {
    return refusal_from_ten(direction + "\nTLON,GOFWD/(CIRCLE/0,0,0,10)" + rest);
  };
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",ON,2,INTOF,(LINE/0,0,0,0,10,0)"),
              StartsWith("8:41: the arc to the end of this line turns 90"));
  EXPECT_THAT(refusal("INDIRV/0,-1,0", ",ON,(LINE/0,0,0,0,10,0)"), HasSubstr("turns 270 degrees"));
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",ON,(LINE/0,0,0,10,0,0)"), HasSubstr("turns 360 degrees"));
  EXPECT_THAT(refusal("INDIRV/1,0,0", ",ON,(LINE/0,0,0,0,10,0)"), HasSubstr("INDIRV does not point along"));
  EXPECT_THAT(refusal("INDIRV/0,0,0", ",ON,(LINE/0,0,0,0,10,0)"),
              StartsWith("7:1: these three numbers tell no direction"));
  EXPECT_THAT(refusal("RAPID", ",ON,(LINE/0,0,0,0,10,0)"), StartsWith("8:1: no INDIRV"));
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",ON,(LINE/1,0,0,0,10,0)"), HasSubstr("does not begin at its centre"));
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",ON,(LINE/0,0,0,0,10,5)"), HasSubstr("5 mm off the plane"));
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",ON,(LINE/0,0,0,0,12,0)"),
              HasSubstr("10 mm from its start and 12 mm from its end"));
  EXPECT_THAT(refusal("INDIRV/0,1,0", ",PAST,(LINE/0,0,0,0,10,0)"), HasSubstr("ends ON a line"));
  EXPECT_THAT(refusal_from_ten("INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,12),ON,(LINE/0,0,0,0,12,0)"),
              HasSubstr("the circle has the radius 12 mm, and the arc begins 10 mm from its centre"));
  EXPECT_THAT(refusal_from_ten("INDIRV/0,1,0\nGOTO/1,1,1"), StartsWith("8:1: INDIRV is taken before arcs only"));
}

TEST(AptNxArc, GoesClockwiseAboutItsAxisToTheGotoBehindIt) {
  const json down = arc_of("CIRCLE/0,0,0,0,0,-1" + kNxTail + "\nPAINT/COLOR,31\nGOTO/0,10,0");
  EXPECT_EQ(down["RotSign"], 1);
  EXPECT_EQ(down["CenterPoint"]["axis"], json({0, 0, 1}));
  EXPECT_EQ(down["MoveID"], 9);
  EXPECT_EQ(arc_of("CIRCLE/0,0,0,0,0,1" + kNxTail + "\nGOTO/0,10,0")["RotSign"], -1);
  const Options options{.circle_axis = CircleAxis::CounterClockwise};
  EXPECT_EQ(arc_of("CIRCLE/0,0,0,0,0,1" + kNxTail + "\nGOTO/0,10,0", options)["RotSign"], 1);
}

TEST(AptNxArc, IsAHelixWhereItsEndIsElsewhereAlongItsAxis) {
  const json helix = arc_of("CIRCLE/0,0,-4,0,0,-1" + kNxTail + ",TIMES,3\nGOTO/10,0,-4");
  EXPECT_EQ(helix["Closed"], true);
  EXPECT_EQ(helix["Turns"], 2);
  EXPECT_EQ(helix["EndPoint"]["p"], json({10, 0, -4}));
  const json part = arc_of("CIRCLE/0,0,0,0,0,-1" + kNxTail + "\nGOTO/0,10,-1");
  EXPECT_EQ(part["Closed"], false);
  EXPECT_EQ(part["EndPoint"]["p"], json({0, 10, -1}));
}

TEST(AptNxArc, ThatLeavesItsTurnsOpenIsRefused) {
  EXPECT_THAT(refusal_from_ten("CIRCLE/0,0,0,0,0,-1" + kNxTail + "\nGOTO/10,0,0"),
              StartsWith("7:1: the arc ends where it begins"));
  EXPECT_THAT(refusal_from_ten("CIRCLE/0,0,0,0,0,-1" + kNxTail + ",TIMES,2\nGOTO/0,10,0"),
              StartsWith("7:1: TIMES of an arc"));
  EXPECT_THAT(refusal_from_ten("CIRCLE/0,0,0,0,0,-1" + kNxTail + ",TIMES,0\nGOTO/10,0,0"), HasSubstr("no turns"));
  EXPECT_EQ(arc_of("CIRCLE/0,0,0,0,0,-1" + kNxTail + ",TIMES,1\nGOTO/10,0,0")["Closed"], true);
}

TEST(AptCircle, OfAnUnknownSystemNeedsItsDirection) {
  const std::string lines = "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0";
  EXPECT_THAT(refusal_from_ten(lines), StartsWith("7:1: whether arcs go clockwise"));
  EXPECT_EQ(arc_of(lines, {.circle_axis = CircleAxis::Clockwise})["RotSign"], -1);
  EXPECT_EQ(arc_of(lines, {.circle_axis = CircleAxis::CounterClockwise})["RotSign"], 1);
  EXPECT_EQ(arc_of("INDIRV/0,-1,0\n" + lines)["RotSign"], -1);
  EXPECT_EQ(arc_of("INDIRV/0,1,0\nCIRCLE/0,0,0,10\nGOTO/0,10,0")["RotSign"], 1);
}

TEST(AptCircle, NeedsTheGotoToItsEnd) {
  const std::string circle = "CIRCLE/0,0,0,0,0,1" + kNxTail;
  EXPECT_THAT(refusal_from_ten(circle), HasSubstr("no GOTO to its arc's end"));
  EXPECT_THAT(refusal_from_ten(circle + "\n" + circle), StartsWith("8:1: the CIRCLE before this has no GOTO"));
  EXPECT_THAT(refusal_from_ten(circle + "\nLOADTL/1"), StartsWith("8:1: the CIRCLE before this"));
  EXPECT_THAT(refusal_from_ten("CIRCLE/0,0,0,0,0,1,0,.06,.5,10,0\nGOTO/1,1,1"), HasSubstr("radius is more than 0"));
  EXPECT_THAT(refusal_from_ten("CIRCLE/0,0,0,0,0,1\nGOTO/1,1,1"), HasSubstr("4 or 7 or 11 numbers"));
}

TEST(AptMovarc, TurnsByItsAngleCounterClockwise) {
  EXPECT_EQ(arc_of("MOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/0,10,0")["RotSign"], 1);
  EXPECT_EQ(arc_of("MOVARC/0,0,0,0,0,1,10,ANGLE,-270\nGOTO/0,10,0")["RotSign"], -1);
  EXPECT_EQ(arc_of("MOVARC/0,0,0,0,0,1,10,ANGLE,360\nGOTO/10,0,0")["Closed"], true);
  const json turns = arc_of("MOVARC/0,0,0,0,0,1,10,ANGLE,810\nGOTO/0,10,5");
  EXPECT_EQ(turns["Turns"], 2);
  EXPECT_EQ(turns["EndPoint"]["p"], json({0, 10, 5}));
  EXPECT_THAT(refusal_from_ten("MOVARC/0,0,0,0,0,1,10,ANGLE,80\nGOTO/0,10,0"),
              StartsWith("7:1: the arc to the GOTO behind it turns 90 degrees"));
  EXPECT_THAT(refusal_from_ten("MOVARC/0,0,0,0,0,1,10\nGOTO/0,10,0"), HasSubstr("taken with ANGLE"));
}

TEST(AptArc, MayHaveAToolThatTurns) {
  const json arc = arc_of("MULTAX/ON\nCIRCLE/0,0,0,0,0,-1" + kNxTail + "\nGOTO/0,10,0,0,.6,.8");
  EXPECT_EQ(arc["StartPoint"]["axis"], json({0, 0, 1}));
  EXPECT_EQ(arc["EndPoint"]["axis"], json({0, 0.6, 0.8}));
}

TEST(AptArc, IsRapidBehindRapid) {
  const auto done =
      imported(program_of("RAPID\nGOTO/10,0,0\nRAPID\nCIRCLE/0,0,0,0,0,-1" + kNxTail + "\nGOTO/0,10,0\nGOTO/1,1,1"));
  EXPECT_THAT(done.methods, testing::ElementsAre("MoveToPathTarget", "MoveToPathTarget", "MoveAlongArc", "SetFeedrate",
                                                 "MoveAlongLine"));
}

}  // namespace
}  // namespace rmac::apt
