#include "unit/clients/legacy/bounds.hpp"

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using legacy::expect_bounds;
using testing::HasSubstr;

std::string refused(const std::string& lines) {
  return refusal_of(program_of(lines));
}

TEST(AptBounds, OfToolsSpeedsFeedsAndTimes) {
  expect_bounds(
      {
          {"LOADTL/{}", "is a whole number, 0 to 9999", {"0", "1", "9999"}, {"-1", "1.5", "10000"}},
          {"LOAD/TOOL,{}", "is a whole number, 0 to 9999", {"0", "9999"}, {"-1", "10000"}},
          {"SELECT/TOOL,{}", "is a whole number, 0 to 9999", {"0", "9999"}, {"-1", "10000"}},
          {"SELCTL/{}", "is a whole number, 0 to 9999", {"0", "9999"}, {"-1", "10000"}},
          {"TOOLNO/{}", "is a whole number, 0 to 9999", {"0", "9999"}, {"-1", "10000"}},
          {"SPINDL/{},CLW", "SPINDL is 0 to 1 000 000", {"0", "0.5", "1000000"}, {"-0.001", "1000000.001"}},
          {"FEDRAT/{},MMPM",
           "the feed is not within 0.01 and 1 000 000",
           {"0.01", "1000000"},
           {"0", "-1", "0.009", "1000000.01"}},
          {"FEDRAT/{},IPM", "the feed is not within 0.01 and 1 000 000", {"0.0004", "39370"}, {"0.0003", "39371"}},
          {"DELAY/{}", "a dwell is 0 to 3600 seconds", {"0", "0.001", "3600"}, {"-0.001", "3600.001"}},
          {"DWELL/{}", "a dwell is 0 to 3600 seconds", {"0", "3600"}, {"-0.001", "3600.001"}},
          {"GOTO/{},0,0", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"GOTO/0,0,{}", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"RAPID\nGOTO/0,{},0",
           "a move beyond 1 000 000 mm",
           {"1000000", "-1000000"},
           {"1000000.001", "-1000000.001"}},
      },
      refused);
}

TEST(AptBounds, OfCycles) {
  expect_bounds(
      {
          {"CYCLE/DRILL,DEPTH,{},CLEAR,1\nGOTO/1,1,0", "the hole's depth, more than 0", {"0.001", "5"}, {"0", "-1"}},
          {"CYCLE/DRILL,FEDTO,{},CLEAR,1\nGOTO/1,1,0", "the hole's depth, more than 0", {"-0.001", "-5"}, {"0", "1"}},
          {"CYCLE/DRILL,DEPTH,5,CLEAR,{}\nGOTO/1,1,0", "0 or more", {"0", "2"}, {"-0.001"}},
          {"CYCLE/DRILL,DEPTH,5,RAPTO,{}\nGOTO/1,1,0", "0 or more", {"0", "2"}, {"-0.001"}},
          {"CYCLE/DEEP,DEPTH,5,CLEAR,1,STEP,{}\nGOTO/1,1,0", "more than 0", {"0.001", "2"}, {"0", "-0.001"}},
          {"CYCLE/BRKCHP,DEPTH,5,CLEAR,1,INCR,{}\nGOTO/1,1,0", "more than 0", {"0.001", "2"}, {"0", "-0.001"}},
          {"CYCLE/DEEP,DEPTH,7,CLEAR,1,STEP,{}\nGOTO/1,1,0", "more than 10000 pecks", {"0.0008"}, {"0.00079"}},
          {"CYCLE/DRILL,DEPTH,5,CLEAR,1,DWELL,{}\nGOTO/1,1,0",
           "a dwell is 0 to 3600 seconds",
           {"0", "3600"},
           {"-0.001", "3600.001"}},
          {"CYCLE/DRILL,DEPTH,5,CLEAR,1,RETURN,{}\nGOTO/1,1,0",
           "RETURN is not above where rapid ends",
           {"1", "2"},
           {"0.999"}},
          {"CYCLE/DRILL,DEPTH,5,CLEAR,1,RETURN,{}\nGOTO/1,1,0", "RETURN,0 means a plane", {}, {"0", "-1"}},
          {"CYCLE/DRILL,DEPTH,5,CLEAR,1,MMPM,{}\nGOTO/1,1,0",
           "the feed is not within",
           {"0.01", "1000000"},
           {"0.009", "1000000.01"}},
      },
      refused);
}

TEST(AptBounds, OfPassages) {
  expect_bounds(
      {
          {"DEFSUB/{0}\nGOTO/1,1,1\nENDSUB\nCALSUB/{0}",
           "is a whole number, 0 to 999999",
           {"0", "999999"},
           {"-1", "1.5", "1000000"}},
          {"INDEX/{0}\nGOTO/1,1,1\nCOPY/{0},SAME,1",
           "is a whole number, 0 to 999999",
           {"0", "999999"},
           {"-1", "1.5", "1000000"}},
          {"INDEX/1\nGOTO/1,1,1\nCOPY/1,SAME,{}",
           "is a whole number, 0 to 10000",
           {"0", "1", "10000"},
           {"-1", "1.5", "10001"}},
      },
      refused);
}

TEST(AptBounds, OfNesting) {
  const auto indexes = [](int depth) {
    std::string lines;
    for (int at = 0; at < depth; ++at) lines += fmt::format("INDEX/{}\n", at);
    lines += "GOTO/1,1,1\n";
    for (int at = depth - 1; at >= 0; --at) lines += fmt::format("COPY/{},SAME,1\n", at);
    return refused(lines);
  };
  EXPECT_EQ(indexes(3), "taken");
  EXPECT_THAT(indexes(9), HasSubstr("too many INDEX"));
  EXPECT_THAT(refused("M=MACRO\nCALL/M\nTERMAC\nCALL/M"), HasSubstr("are too many; a macro may call itself"));
  const auto calls = [](int depth) {
    std::string lines = "M0=MACRO\nGOTO/1,1,1\nTERMAC\n";
    for (int at = 1; at < depth; ++at) lines += fmt::format("M{}=MACRO\nCALL/M{}\nTERMAC\n", at, at - 1);
    return refused(lines + fmt::format("CALL/M{}", depth - 1));
  };
  EXPECT_EQ(calls(8), "taken");
  EXPECT_THAT(calls(9), HasSubstr("are too many; a macro may call itself"));
}

/// Words that may stand behind a tool's number, as post-processors of many machines take them.
TEST(AptTool, HasWordsBehindItsNumberThatMeanNothingHere) {
  for (const std::string word : {"ADJUST,1", "ZOFF,2", "OSETNO,3", "OFFSET,4", "LENGTH,50.5", "IN,1", "MILL", "DRILL",
                                 "NOTE", "AUTO", "HOLDER,7", "HEAD,1", "PLUS", "SETOOL,0,0,50"}) {
    for (const std::string statement : {"LOADTL/5", "LOAD/TOOL,5", "SELCTL/5", "SELECT/TOOL,5"})
      EXPECT_EQ(refused(statement + "," + word), "taken") << word;
  }
  for (const std::string word : {"MINUS", "BOTH", "TOOL", "ON"})
    EXPECT_THAT(refused("LOADTL/5," + word), HasSubstr(word + " is not understood here"));
  EXPECT_THAT(refused("LOAD/5"), HasSubstr("LOAD is taken as LOAD/TOOL,n"));
  EXPECT_THAT(refused("SELECT/5"), HasSubstr("SELECT is taken as SELECT/TOOL,n"));
}

/// Each major word needs what it is about: nothing is guessed where it is left out.
TEST(AptStatement, ThatLacksItsPartsSaysWhich) {
  for (const auto& [lines, why] : std::vector<std::pair<std::string, std::string>>{
           {"LOADTL", "LOADTL lacks a tool's number"},
           {"LOADTL/IN", "LOADTL: IN where a tool's number is to stand"},
           {"FEDRAT", "FEDRAT lacks a feed"},
           {"FEDRAT/MMPM", "FEDRAT lacks a feed"},
           {"FEDRAT/FAST", "FEDRAT: FAST where a feed is to stand"},
           {"DELAY", "DELAY lacks seconds"},
           {"DELAY/,1", "DELAY: nothing where seconds is to stand"},
           {"DELAY/(CIRCLE/0,0,0,5)", "DELAY: (CIRCLE/…) where seconds is to stand"},
           {"COOLNT", "COOLNT lacks ON, FLOOD, MIST or OFF"},
           {"COOLNT/5", "COOLNT: 5 where ON, FLOOD, MIST or OFF is to stand"},
           {"CYCLE", "CYCLE lacks a type as DRILL"},
           {"CALL", "CALL lacks a macro's name"},
           {"COPY/1", "no INDEX/1 before this COPY"},
           {"GOTO", "here are 0"},
       })
    EXPECT_THAT(refused(lines), HasSubstr(why)) << lines;
}

/// Statements that a verb takes have no more parts than are said, whichever verb it is.
TEST(AptStatement, IsRefusedForAPartBehindItsLast) {
  for (const std::string statement :
       {"RAPID",      "GOTO/1,2,3", "GODLTA/1",  "FEDRAT/600", "UNITS/MM",    "MULTAX/ON", "COOLNT/ON",
        "DELAY/1",    "STOP",       "OPSTOP",    "END",        "END-OF-PATH", "FINI",      "MODE/MILL",
        "CUTCOM/OFF", "SPINDL/OFF", "CYCLE/OFF", "OPSKIP/OFF", "ARCSLP/ON",   "GOHOME"}) {
    const bool has_parts = statement.find('/') != std::string::npos;
    EXPECT_THAT(refused(statement + (has_parts ? ",WRONG" : "/WRONG")), HasSubstr("WRONG is not understood here"))
        << statement;
  }
}

/// What cuts is refused while another tool is in the spindle than the program speaks of; nothing else is.
TEST(AptTool, ThatIsNotInTheSpindleStopsWhatMoves) {
  Options options;
  options.reference_mm = {0, 0, 100};
  const auto said = [&](const std::string& statement) {
    return refusal_of(program_of("INDIRV/1,0,0\nTOOLNO/7,10\n" + statement), options);
  };
  for (const std::string moves : {"GOTO/1,1,1", "GODLTA/1", "GODLTA/1,2,3", "GOHOME"})
    EXPECT_THAT(said(moves), HasSubstr("TOOLNO says that tool 7 cuts")) << moves;
  EXPECT_THAT(said("CIRCLE/0,0,10,5\nTLON,GOFWD/(CIRCLE/0,0,10,5),ON,(LINE/0,0,10,5,0,10)"),
              HasSubstr("TOOLNO says that tool 7 cuts"));
  for (const std::string rests :
       {"FEDRAT/100", "RAPID",        "SPINDL/100,CLW", "COOLNT/ON",  "LOADTL/7",    "SELCTL/7",
        "DELAY/1",    "DWELL/1",      "STOP",           "OPSTOP",     "CYCLE/OFF",   "UNITS/MM",
        "MULTAX/ON",  "TLAXIS/0,0,1", "TRANS/0,0,1",    "FROM/0,0,0", "CUTCOM/OFF",  "MODE/MILL",
        "ARCSLP/ON",  "OPSKIP/OFF",   "ORIGIN/0,0,0",   "END",        "END-OF-PATH", "PSIS/(PLANE/0,0,1,0)"})
    EXPECT_THAT(said(rests), testing::Not(HasSubstr("TOOLNO"))) << rests;
}

TEST(AptCoordinates, HaveAxesOfUnitLengthThatRoundingMayLeaveOff) {
  expect_bounds(
      {
          {"MULTAX/ON\nTLAXIS/0,0,{}",
           "a tool axis has the length 1",
           {"1", "1.0009", "0.9991", "-1"},
           {"1.0011", "0.9989", "0", "2"}},
          {"MULTAX/ON\nTLAXIS/0.6,{},0.8", "a tool axis has the length 1", {"0"}, {"1"}},
          {"GOTO/0,0,0,{},0,1",
           "is not Z, and no MULTAX/ON is in force",
           {"0", "0.0000019", "-0.0000019"},
           {"0.0000021", "-0.0000021"}},
          {"GOTO/0,0,0,0,{},1",
           "is not Z, and no MULTAX/ON is in force",
           {"0", "0.0000019", "-0.0000019"},
           {"0.0000021", "-0.0000021"}},
          {"GOTO/0,0,0,0,0,{}", "is not Z, and no MULTAX/ON is in force", {"1"}, {"-1"}},
          {"UNITS/{}",
           "is not taken; write MM or INCHES",
           {"MM", "MILLIMETERS", "INCH", "INCHES"},
           {"CM", "M", "FEET"}},
          {"ORIGIN/{},0,0", "ORIGIN that is not 0,0,0", {"0"}, {"1", "-0.001"}},
      },
      refused);
  const auto axis_of = [](const std::string& tool_axis) {
    return end_of(moves_of("MULTAX/ON\nGOTO/1,1,1," + tool_axis).back()).at("axis").get<std::vector<double>>();
  };
  EXPECT_THAT(axis_of("0.000000009,0,1"), testing::ElementsAre(0, 0, 1)) << "rounding of an upright tool";
  EXPECT_THAT(axis_of("0,0.000000009,1"), testing::ElementsAre(0, 0, 1));
  EXPECT_THAT(axis_of("0.00000002,0,1"), testing::ElementsAre(testing::DoubleNear(2e-8, 1e-10), 0, 1));
  EXPECT_THAT(axis_of("0,0.00000002,1"), testing::ElementsAre(0, testing::DoubleNear(2e-8, 1e-10), 1));
  EXPECT_THAT(axis_of("0,0,-1"), testing::ElementsAre(0, 0, -1));
  EXPECT_THAT(axis_of("0.6006,0,0.8008"),
              testing::ElementsAre(testing::DoubleNear(0.6, 1e-9), 0, testing::DoubleNear(0.8, 1e-9)));
}

/// As rs274 has it of arcs: 0.005 mm, or a thousandth of the radius up to 0.5 mm, either way.
TEST(AptCircle, HasTheRadiusThatItsBeginHas) {
  const auto begun_at = [](double radius, double x) {
    return refused(
        fmt::format("GOTO/{0:.6f},0,10\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,10,{1:.6f}),ON,(LINE/0,0,10,0,{1:.6f},10)",
                    x, radius));
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(begun_at(2, 2 + sign * 0.00499), "taken");
    EXPECT_THAT(begun_at(2, 2 + sign * 0.00501), HasSubstr("the circle has the radius 2 mm, and the arc begins"));
    EXPECT_EQ(begun_at(100, 100 + sign * 0.0999), "taken");
    EXPECT_THAT(begun_at(100, 100 + sign * 0.1001), HasSubstr("the circle has the radius 100 mm"));
    EXPECT_EQ(begun_at(9000, 9000 + sign * 0.4999), "taken");
    EXPECT_THAT(begun_at(9000, 9000 + sign * 0.5001), HasSubstr("the circle has the radius 9000 mm"));
  }
}

TEST(AptPassages, SayWhatIsMissing) {
  for (const auto& [lines, why] : std::vector<std::pair<std::string, std::string>>{
           {"M=MACRO\nTERMAC\nM=MACRO", "MACRO M is there already"},
           {"DEFSUB/1\nENDSUB\nDEFSUB/1", "DEFSUB #1 is there already"},
           {"M=MACRO\nN=MACRO", "a MACRO or DEFSUB within another one"},
           {"M=MACRO\nDEFSUB/1", "a MACRO or DEFSUB within another one"},
           {"M=MACRO", "FINI before the end of M"},
           {"MACRO", "a MACRO has a name: NAME=MACRO"},
           {"TERMAC", "TERMAC without what it ends"},
           {"ENDSUB", "ENDSUB without what it ends"},
           {"CALL/M", "there is no macro M before this"},
           {"CALSUB/1", "there is no DEFSUB/1 before this"},
           {"M=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/M", "A of M is not given"},
           {"M=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/M,B=2", "this is no parameter of M"},
           {"M=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/M,2", "this is no parameter of M"},
           {"M=MACRO/5\nTERMAC", "this is no parameter's name"},
           {"DEFSUB/1,A\nENDSUB", "this is no parameter's name"},
           {"INDEX/1\nINDEX/1", "INDEX/1 has no COPY yet"},
           {"INDEX/1", "INDEX/1 has no COPY"},
           {"INDEX/1\nCOPY/1,MODIFY,2", "COPY is taken with SAME, TRANSL, XYROT, YZROT and ZXROT"},
           {"INDEX/1\nCOPY/1,TRANSL,1,2", "COPY lacks z"},
       })
    EXPECT_THAT(refused(lines), HasSubstr(why)) << lines;
  EXPECT_EQ(refused("M=MACRO/A,B=2\nGOTO/A,B,0\nTERMAC\nCALL/M,A=1\nCALL/M,A=1,B=3"), "taken");
}

}  // namespace
}  // namespace rmac::apt
