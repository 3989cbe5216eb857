#include <gmock/gmock.h>

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// The heights that a hole's moves end at, each with how it is reached: r, or f at a feed.
std::string heights_of(const std::string& lines) {
  std::string heights;
  for (const json& move : moves_of(lines)) {
    const bool rapid = move["method"] == "RMAC_CAM.MoveToPathTarget";
    heights += fmt::format("{}{:g} ", rapid ? "r" : "f", end_of(move)["p"][2].get<double>());
  }
  return heights;
}

TEST(AptCycle, DrillsBelowEachGotoAndComesBackToWhereRapidEnds) {
  EXPECT_THAT(ends_of("CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2\nGOTO/1,0,0\nGOTO/2,0,0\nCYCLE/OFF\nGOTO/2,0,9"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(1, 0, 2), ElementsAre(1, 0, -5), ElementsAre(1, 0, 2),
                          ElementsAre(2, 0, 2), ElementsAre(2, 0, -5), ElementsAre(2, 0, 2), ElementsAre(2, 0, 9)));
}

TEST(AptCycle, IsReadInEveryFormThatCamSystemsWrite) {
  for (const auto* line :
       {"CYCLE/DRILL,DEPTH,5,MMPM,100,CLEAR,2", "CYCLE/DRILL,5,100,MMPM,2", "CYCLE/DRILL,5,MMPM,100,2",
        "CYCLE/DRILL,RAPTO,2,FEDTO,-5,MMPM,100", "CYCLE/DRILL,5,FEED,100,MMPM,CLEAR,2",
        "CYCLE/FACE,DEPTH,5,100,PERMIN,CLEAR,2", "CYCLE/CBORE,DEPTH,5,FEED,100,CLEAR,2"}) {
    const auto done = imported(program_of(std::string(line) + "\nGOTO/0,0,0\nCYCLE/OFF"));
    EXPECT_THAT(done.methods,
                ElementsAre("MoveToPathTarget", "MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveToPathTarget"))
        << line;
    EXPECT_EQ(done.requests.at(2)["params"]["Feedrate"], 100) << line;
    EXPECT_EQ(end_of(done.requests.at(3))["p"], json({0, 0, -5})) << line;
    EXPECT_EQ(end_of(done.requests.at(4))["p"], json({0, 0, 2})) << line;
  }
}

TEST(AptCycle, PecksDwellsAndComesUpAsItsTypeSays) {
  EXPECT_EQ(heights_of("CYCLE/DEEP,DEPTH,5,STEP,3,CLEAR,1\nGOTO/0,0,0"), "r1 f-2 r1 r-1.746 f-5 r1 ");
  EXPECT_EQ(heights_of("CYCLE/DRILL,DEEP,DEPTH,5,INCR,3,CLEAR,1\nGOTO/0,0,0"), "r1 f-2 r1 r-1.746 f-5 r1 ");
  EXPECT_EQ(heights_of("CYCLE/BRKCHP,DEPTH,5,STEP,3,CLEAR,1\nGOTO/0,0,0"), "r1 f-2 r-1.746 f-5 r1 ");
  EXPECT_EQ(heights_of("CYCLE/BORE,DEPTH,5,CLEAR,1\nGOTO/0,0,0"), "r1 f-5 f1 ");
  EXPECT_EQ(heights_of("CYCLE/REAM,DEPTH,5,CLEAR,1\nGOTO/0,0,0"), "r1 f-5 f1 ");
  EXPECT_THAT(
      imported(program_of("CYCLE/DRILL,DEPTH,5,CLEAR,1,DWELL,2\nGOTO/0,0,0")).methods,
      ElementsAre("MoveToPathTarget", "MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "Dwell", "MoveToPathTarget"));
}

TEST(AptCycle, ComesBackAsFarAsItSays) {
  EXPECT_EQ(heights_of("CYCLE/DRILL,DEPTH,5,CLEAR,1,RETURN,7\nGOTO/0,0,0\nGOTO/1,0,-1"), "r1 f-5 r7 r7 r0 f-6 r6 ");
  EXPECT_EQ(heights_of("CYCLE/DRILL,DEPTH,5,CLEAR,1,RTRCTO,AUTO\nGOTO/0,0,0\nGOTO/1,0,-1"),
            "r1 f-5 r10 r10 r0 f-6 r10 ");
}

TEST(AptCycle, RisesBeforeItGoesAcross) {
  EXPECT_EQ(heights_of("CYCLE/DRILL,DEPTH,5,CLEAR,1\nGOTO/0,0,0\nGOTO/5,0,20"), "r1 f-5 r1 r21 r21 f15 r21 ");
}

TEST(AptCycle, GoesOnWithOn) {
  EXPECT_EQ(heights_of("CYCLE/DRILL,DEPTH,5,CLEAR,1\nCYCLE/OFF\nGOTO/0,0,2\nCYCLE/ON\nGOTO/0,0,0"), "f2 r1 f-5 r1 ");
  EXPECT_THAT(refusal_of(program_of("CYCLE/ON")), HasSubstr("without a cycle before it"));
}

TEST(AptCycle, GoesAlongTheToolAxis) {
  EXPECT_THAT(ends_of("MULTAX/ON\nRAPID\nGOTO/10,0,0,1,0,0\nCYCLE/DRILL,DEPTH,5,CLEAR,1\nGOTO/0,0,0"),
              ElementsAre(ElementsAre(10, 0, 0), ElementsAre(1, 0, 0), ElementsAre(-5, 0, 0), ElementsAre(1, 0, 0)));
  EXPECT_THAT(refusal_of(program_of("MULTAX/ON\nCYCLE/DRILL,DEPTH,5,CLEAR,1\nGOTO/0,0,0,1,0,0")),
              StartsWith("7:1: the tool axis turns on the way to a hole"));
}

TEST(AptCycle, ThatLeavesSomethingOpenIsRefused) {
  const auto refusal = [](const std::string& cycle) {
    return refusal_of(program_of("CYCLE/" + cycle + "\nGOTO/0,0,0"));
  };
  EXPECT_THAT(refusal("TAP,DEPTH,5,CLEAR,1"), StartsWith("5:7: CYCLE/TAP needs a feed by the spindle's angle"));
  EXPECT_THAT(refusal("MILL,DEPTH,5,CLEAR,1"), HasSubstr("write its moves instead"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1,RAPTO,2"), HasSubstr("CLEAR and RAPTO"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5"), HasSubstr("needs CLEAR"));
  EXPECT_THAT(refusal("DRILL,CLEAR,5"), HasSubstr("needs the hole's depth"));
  EXPECT_THAT(refusal("DRILL,FEDTO,5,CLEAR,1"), HasSubstr("needs the hole's depth"));
  EXPECT_THAT(refusal("DEEP,DEPTH,5,CLEAR,1"), HasSubstr("needs STEP"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1,STEP,1"), HasSubstr("does not peck"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,DEPTH,6,CLEAR,1"), HasSubstr("the depth is said twice"));
  EXPECT_THAT(refusal("DRILL,5,100,MMPM,2,3"), HasSubstr("no word before it tells"));
  EXPECT_THAT(refusal("DRILL,5,2,100,MMPM"), StartsWith("5:15: which of the cycle's numbers"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,MMPR,.1,CLEAR,1"), HasSubstr("not by the turn of the spindle"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1,ORIENT,90"), HasSubstr("ORIENT is not understood here"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1,RETURN,0"), HasSubstr("RETURN,0 means a plane"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,3,RETURN,1"), HasSubstr("not above where rapid ends"));
  EXPECT_THAT(refusal("DEEP,DEPTH,500,STEP,.01,CLEAR,1"), HasSubstr("more than 10000 pecks"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1\nRAPID"), HasSubstr("RAPID to a hole of a CYCLE"));
  EXPECT_THAT(refusal("DRILL,DEPTH,5,CLEAR,1\nGODLTA/1,1,1"), HasSubstr("GODLTA where a CYCLE is in force"));
}

}  // namespace
}  // namespace rmac::apt
