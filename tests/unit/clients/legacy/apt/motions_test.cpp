#include <gmock/gmock.h>

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(AptMotion, IsALineOrAfterRapidPositioningOfTheNextMotionOnly) {
  const auto done = imported(program_of("GOTO/5,0,10\nRAPID\nGOTO/5,0,20\nGOTO/6,0,20"));
  EXPECT_THAT(done.methods, ElementsAre("MoveToPathTarget", "SetFeedrate", "MoveAlongLine", "MoveToPathTarget",
                                        "SetFeedrate", "MoveAlongLine"));
  EXPECT_EQ(done.requests[2]["params"]["StartPoint"], json({{"p", {0, 0, 10}}, {"axis", {0, 0, 1}}}));
  EXPECT_EQ(done.requests[2]["params"]["EndPoint"]["p"], json({5, 0, 10}));
  EXPECT_EQ(done.requests[5]["params"]["StartPoint"]["p"], json({5, 0, 20}));
}

TEST(AptMotion, RemembersTheLineOfItsStatement) {
  const auto moves = moves_of("$$ nothing\nGOTO/1,$\n  0,10\nGOTO/2,0,10");
  EXPECT_EQ(moves[0]["params"]["MoveID"], 6);
  EXPECT_EQ(moves[1]["params"]["MoveID"], 8);
}

TEST(AptMotion, NeedsAnUnit) {
  EXPECT_THAT(refusal_of("RAPID\nGOTO/0,0,1\nFINI\n"), StartsWith("2:1: no UNITS says"));
  EXPECT_EQ(refusal_of("RAPID\nGOTO/0,0,1\nFINI\n", {.unit_mm = 1}), "taken");
  EXPECT_THAT(ends_of("UNITS/INCHES\nGOTO/1,0,10"), ElementsAre(ElementsAre(25.4, 0, 254)));
  EXPECT_THAT(ends_of("UNITS/INCH\nGOTO/1,0,1\nUNITS/MM\nGOTO/1,0,1"),
              ElementsAre(ElementsAre(25.4, 0, 25.4), ElementsAre(1, 0, 1)));
  EXPECT_THAT(refusal_of("UNITS/FEET\n"), HasSubstr("write MM or INCHES"));
}

TEST(AptMotion, HasItsFeedInEveryFormThatCamSystemsWrite) {
  const auto feed_of_line = [](const std::string& line) {
    return imported(program_of(line + "\nGOTO/1,0,10")).requests.at(1)["params"]["Feedrate"].get<double>();
  };
  EXPECT_EQ(feed_of_line("FEDRAT/250"), 250);
  EXPECT_EQ(feed_of_line("FEDRAT/MMPM,250"), 250);
  EXPECT_EQ(feed_of_line("FEDRAT/250.,MMPM"), 250);
  EXPECT_EQ(feed_of_line("FEDRAT/10,IPM"), 254);
  EXPECT_EQ(feed_of_line("FEDRAT/10,PERMIN"), 10);
  EXPECT_EQ(feed_of_line("FEDRAT/IPM,1\nFEDRAT/10"), 254);
  EXPECT_EQ(imported("UNITS/INCH\nRAPID\nGOTO/0,0,0\nFEDRAT/10\nGOTO/1,0,0\nFINI").requests.at(1)["params"]["Feedrate"],
            254);
  EXPECT_EQ(feed_of_line("UNITS/INCHES\nFEDRAT/10,PERMIN\nUNITS/MM"), 254);
  EXPECT_EQ(feed_of_line("UNITS/INCHES\nFEDRAT/100,MMPM\nUNITS/MM"), 100);
  for (const auto* line : {"FEDRAT/.1,MMPR", "FEDRAT/IPR,.01", "FEDRAT/PERREV,.1"})
    EXPECT_THAT(refusal_of(program_of(line)), HasSubstr("not by the turn of the spindle"));
  EXPECT_THAT(refusal_of(program_of("FEDRAT/0,MMPM")), HasSubstr("the feed is not within"));
  EXPECT_THAT(refusal_of(program_of("RAPID\nFEDRAT/9\nGOTO/1,1,1")), StartsWith("6:1: FEDRAT between RAPID"));
  EXPECT_THAT(refusal_of("UNITS/MM\nRAPID\nGOTO/0,0,0\nGOTO/1,0,0\nFINI"), StartsWith("4:1: no feed was set"));
}

TEST(AptMotion, IsRefusedWhereItsStartIsNotKnown) {
  const std::string program = "UNITS/MM\nFROM/0,0,100\nFEDRAT/9\nGOTO/0,0,10\nFINI\n";
  EXPECT_THAT(refusal_of(program), StartsWith("4:1: where the tool is before this move is not known (FROM"));
  const auto done = imported(program, {.approach_mm = Point{1, 2, 50}});
  EXPECT_EQ(end_of(done.requests.at(0))["p"], json({1, 2, 50}));
  EXPECT_EQ(end_of(done.requests.at(2))["p"], json({0, 0, 10}));
  EXPECT_THAT(refusal_of(program_of("LOADTL/2\nGOTO/1,1,1")), StartsWith("6:1: where the tool is"));
  EXPECT_EQ(refusal_of(program_of("LOADTL/2\nRAPID\nGOTO/1,1,1")), "taken");
}

TEST(AptMotion, GoesByIncrementsAndAlongTheToolAxis) {
  EXPECT_THAT(ends_of("GODLTA/1,2,0\nGODLTA/0,0,-3\nRAPID\nGODLTA/5"),
              ElementsAre(ElementsAre(1, 2, 10), ElementsAre(1, 2, 7), ElementsAre(1, 2, 12)));
  EXPECT_EQ(moves_of("RAPID\nGODLTA/5")[0]["method"], "RMAC_CAM.MoveToPathTarget");
  EXPECT_THAT(ends_of("MULTAX/ON\nRAPID\nGOTO/0,0,0,1,0,0\nGODLTA/5"),
              ElementsAre(ElementsAre(0, 0, 0), ElementsAre(5, 0, 0)));
}

TEST(AptMotion, IsShiftedByTransUntilTheNextTrans) {
  EXPECT_THAT(ends_of("TRANS/100,0,-1\nGOTO/1,0,0\nGODLTA/1,0,0\nTRANS/0,0,0\nGOTO/1,0,0"),
              ElementsAre(ElementsAre(101, 0, -1), ElementsAre(102, 0, -1), ElementsAre(1, 0, 0)));
}

TEST(AptMotion, CarriesTheToolAxisUnderMultax) {
  const auto moves = moves_of("MULTAX/ON\nGOTO/0,0,5,.6,0,.8\nGOTO/1,0,5\nGOTO/2,0,5,0,-.6,.8");
  EXPECT_EQ(moves[0]["params"]["StartPoint"]["axis"], json({0, 0, 1}));
  EXPECT_EQ(moves[0]["params"]["EndPoint"]["axis"], json({0.6, 0, 0.8}));
  EXPECT_EQ(moves[1]["params"]["EndPoint"]["axis"], json({0.6, 0, 0.8}));
  EXPECT_EQ(moves[2]["params"]["StartPoint"]["axis"], json({0.6, 0, 0.8}));
  EXPECT_EQ(moves[2]["params"]["EndPoint"]["axis"], json({0, -0.6, 0.8}));
  EXPECT_EQ(moves_of("MULTAX\nTLAXIS/0,.6,.8\nGOTO/1,0,5")[0]["params"]["EndPoint"]["axis"], json({0, 0.6, 0.8}));
}

TEST(AptMotion, TurnsTheToolWithoutAWay) {
  const auto moves = moves_of("MULTAX/ON\nGOTO/0,0,10,.6,0,.8");
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_EQ(moves[0]["params"]["StartPoint"]["p"], moves[0]["params"]["EndPoint"]["p"]);
}

TEST(AptMotion, WithATiltedToolIsRefusedWithoutMultax) {
  EXPECT_THAT(refusal_of(program_of("GOTO/0,0,5,.6,0,.8")), StartsWith("5:1: the tool axis 0.6,0,0.8 is not Z"));
  EXPECT_THAT(refusal_of(program_of("TLAXIS/0,.6,.8\nGOTO/1,2,3")), StartsWith("6:1: the tool axis"));
  EXPECT_THAT(refusal_of(program_of("MULTAX/ON\nGOTO/0,0,5,.6,0,.8\nMULTAX/OFF\nGOTO/1,2,3")),
              StartsWith("8:1: the tool"));
  EXPECT_EQ(refusal_of(program_of("GOTO/0,0,5,0,0,1.0000001")), "taken");
  EXPECT_EQ(refusal_of(program_of("GOTO/0,0,5,.6,0,.8"), {.multax = true}), "taken");
  EXPECT_EQ(refusal_of(program_of("GOTO/0,0,5,0.000001,-0.0000010,1.0")), "taken")
      << "digits that a CAM system rounded";
  EXPECT_NE(refusal_of(program_of("GOTO/0,0,5,0.00001,0,1.0")), "taken");
  EXPECT_THAT(refusal_of(program_of("MULTAX/ON\nGOTO/0,0,5,.6,0,.7")), HasSubstr("has the length 1"));
}

TEST(AptMotion, GoesHomeOnlyWhereHomeIsKnown) {
  EXPECT_THAT(refusal_of(program_of("RAPID\nGOHOME")), StartsWith("6:1: where the machine's home is"));
  const auto done = imported(program_of("RAPID\nGOHOME"), {.reference_mm = Point{0, 0, 200}});
  EXPECT_EQ(end_of(done.requests.back())["p"], json({0, 0, 200}));
}

TEST(AptMotion, BeyondTheAppliancesReachIsRefused) {
  EXPECT_THAT(refusal_of(program_of("GOTO/1E7,0,0")), StartsWith("5:1: a move beyond"));
  EXPECT_THAT(refusal_of(program_of("GOTO/1E300,0,0")), StartsWith("5:1: a move beyond"));
}

TEST(AptMotion, InAnotherAxisSystemIsRefused) {
  const std::string nx = "MSYS/0,0,0,1,0,0,0,1,0\n", other = "MSYS/50,0,0,1,0,0,0,1,0\n";
  EXPECT_EQ(refusal_of(program_of(nx + nx)), "taken");
  EXPECT_THAT(refusal_of(program_of(nx + other)), StartsWith("6:1: another axis system"));
  const std::string head = "$$*CATIA0\n$$ Program.1\n$$ 1 0 0 0\n$$ 0 1 0 0\n";
  EXPECT_EQ(refusal_of(program_of(head + "$$ 0 0 1 0\n" + head + "$$ 0 0 1.00001 0\n")), "taken");
  EXPECT_THAT(refusal_of(program_of(head + "$$ 0 0 1 0\n" + head + "$$ 0 0 1 20\n")),
              StartsWith("14:1: another axis system"));
  EXPECT_EQ(refusal_of(program_of(head + "RAPID\n$$ 0 0 1 20\nGOTO/1,1,1")), "taken");  // no matrix: comments
  const std::string creo = "$$-> CSYS / 1., 0., 0., 0., $\n 0., 1., 0., 0., $\n 0., 0., 1., ";
  EXPECT_EQ(refusal_of(program_of(creo + "0.\n" + creo + "0.")), "taken");
  EXPECT_THAT(refusal_of(program_of(creo + "0.\n" + creo + "7.")), StartsWith("8:1: another axis system"));
  EXPECT_THAT(refusal_of(program_of("ORIGIN/10,0,0")), HasSubstr("ORIGIN that is not 0,0,0"));
}

}  // namespace
}  // namespace rmac::apt
