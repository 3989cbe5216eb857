#include <gmock/gmock.h>

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// The calls of a program's lines that stand between moves, with what they are given.
std::vector<std::string> switched(const std::string& lines) {
  std::vector<std::string> calls;
  for (const json& request : imported(program_of(lines)).requests) {
    if (request["method"] != "RMAC_CAM.InTurn") continue;
    for (const json& call : request["params"]["Calls"]) {
      calls.push_back(call["method"].get<std::string>().substr(9));
      if (call.contains("params") && call["params"].contains("RPM"))
        calls.back() += fmt::format(" {}", call["params"]["RPM"].get<double>());
    }
  }
  return calls;
}

TEST(AptSpindle, TurnsAsItIsSaidInAnyOrder) {
  for (const auto* line :
       {"SPINDL/800,CLW", "SPINDL/800,RPM,CLW", "SPINDL/RPM,800,CLW", "SPINDL/CLW,800,RPM", "SPINDL/ON,800,CLW"})
    EXPECT_THAT(switched(line), ElementsAre("SetSpindleRPM 800", "SetSpindleRPM 0")) << line;
  EXPECT_THAT(switched("SPINDL/800,CCLW\nSPINDL/OFF\nSPINDL/ON\nSPINDL/900"),
              ElementsAre("SetSpindleRPM -800", "SetSpindleRPM 0", "SetSpindleRPM -800", "SetSpindleRPM -900",
                          "SetSpindleRPM 0"));
}

TEST(AptSpindle, IsRefusedWhereItsWayOrSpeedIsNotKnown) {
  EXPECT_THAT(refusal_of(program_of("SPINDL/800")), StartsWith("5:1: which way the spindle turns was not said"));
  EXPECT_THAT(refusal_of(program_of("SPINDL/CLW")), HasSubstr("how fast"));
  EXPECT_THAT(refusal_of(program_of("SPINDL/200,SFM,CLW")), StartsWith("5:12: SPINDL: SFM is not taken"));
  EXPECT_THAT(refusal_of(program_of("SPINDL/-5,CLW")), HasSubstr("CCLW turns the other way"));
}

TEST(AptCoolant, IsFloodOrMist) {
  EXPECT_THAT(switched("COOLNT/ON\nCOOLNT/FLOOD\nCOOLNT/MIST\nCOOLNT/OFF"),
              ElementsAre("TurnCoolantOn", "SetOutput", "TurnCoolantOff", "SetOutput"));
  EXPECT_THAT(refusal_of(program_of("COOLNT/THRU")), StartsWith("5:8: COOLNT/THRU is not taken"));
}

TEST(AptTool, IsChangedByLoadtlAndByNxsLoad) {
  for (const auto* line : {"LOADTL/3", "LOADTL/3,ADJUST,1,LENGTH,100.", "LOADTL/3,1", "LOAD/TOOL,3,ADJUST,3"}) {
    const auto done = imported(program_of(line));
    EXPECT_EQ(
        done.requests.at(1),
        json({{"jsonrpc", "2.0"}, {"id", 3}, {"method", "RMAC_CAM.DoToolChange"}, {"params", {{"ToolNumber", 3}}}}))
        << line;
  }
  EXPECT_THAT(refusal_of(program_of("LOADTL/1.5")), HasSubstr("is a whole number"));
  EXPECT_THAT(refusal_of(program_of("LOADTL/1,MANUAL")), HasSubstr("MANUAL is not understood here"));
  EXPECT_THAT(imported(program_of("SELECT/TOOL,4")).methods, ElementsAre("MoveToPathTarget"));
}

TEST(AptTool, ThatIsDescribedHasToBeLoaded) {
  EXPECT_THAT(refusal_of(program_of("TOOLNO/2,MILL,10,,5\nGOTO/1,1,1")),
              StartsWith("6:1: TOOLNO says that tool 2 cuts"));
  EXPECT_EQ(refusal_of(program_of("TOOLNO/2,MILL\nLOADTL/2\nRAPID\nGOTO/1,1,1")), "taken");
  EXPECT_EQ(refusal_of(program_of("LOADTL/2\nTOOLNO/2,MILL\nRAPID\nGOTO/1,1,1")), "taken");
  const std::string first = "TOOL PATH/A,TOOL,MILL_10\nGOTO/1,1,1\nEND-OF-PATH\n";
  EXPECT_EQ(refusal_of(program_of(first + "TOOL PATH/B,TOOL,MILL_10\nGOTO/2,1,1")), "taken");
  EXPECT_THAT(refusal_of(program_of(first + "TOOL PATH/B,TOOL,DRILL\nGOTO/2,1,1")),
              StartsWith("9:1: TOOL PATH names another tool, DRILL"));
  EXPECT_EQ(refusal_of(program_of(first + "TOOL PATH/B,TOOL,DRILL\nLOAD/TOOL,2\nRAPID\nGOTO/2,1,1")), "taken");
}

TEST(AptStop, TellsThePrintRightBeforeIt) {
  const auto done = imported(program_of("PPRINT turn it over\nSTOP\nPPRINT old\nGOTO/1,1,1\nOPSTOP"));
  ASSERT_THAT(done.methods,
              ElementsAre("MoveToPathTarget", "ProgramStop", "SetFeedrate", "MoveAlongLine", "ProgramStop"));
  EXPECT_EQ(done.requests[1]["params"], json({{"MoveID", 6}, {"Optional", false}, {"Message", "turn it over"}}));
  EXPECT_EQ(done.requests[4]["params"], json({{"MoveID", 9}, {"Optional", true}}));
}

TEST(AptDwell, IsInSeconds) {
  for (const auto* line : {"DELAY/1.5", "DWELL/1.5"})
    EXPECT_EQ(imported(program_of(line)).requests.at(1)["params"]["Time"], 1.5);
  EXPECT_THAT(refusal_of(program_of("DELAY/REV,2")), HasSubstr("not in turns"));
  EXPECT_THAT(refusal_of(program_of("DELAY/-1")), HasSubstr("0 to 3600"));
}

TEST(AptEnd, HasToBeThereAndSwitchesOff) {
  const std::string program = "UNITS/MM\nSPINDL/9,CLW\nCOOLNT/ON\nRAPID\nGOTO/0,0,0\n";
  EXPECT_THAT(refusal_of(program), HasSubstr("it may be cut off"));
  for (const auto* end :
       {"FINI\n", "END\nFINI\n", "END", "END-OF-PATH\n", "END-OF-PATH\n$$ done\n", "END\nREWIND\nFINI"}) {
    const auto done = imported(program + end);
    ASSERT_FALSE(done.requests.empty());
    EXPECT_EQ(done.requests.back()["params"]["Calls"].size(), 2U) << end;
  }
  EXPECT_THAT(refusal_of(program + "END-OF-PATH\nTOOL PATH/B,TOOL,T\n"), HasSubstr("cut off"));
  EXPECT_THAT(refusal_of(program + "END\nGOTO/1,1,1\nFINI"), StartsWith("7:1: GOTO behind END"));
  EXPECT_EQ(refusal_of(program + "FINI\nwhat stands here is not read"), "taken");
  EXPECT_THAT(imported("FINI").requests, IsEmpty());
}

}  // namespace
}  // namespace rmac::apt
