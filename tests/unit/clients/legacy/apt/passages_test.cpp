#include <gmock/gmock.h>

#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using Ends = std::vector<std::vector<double>>;

TEST(AptCopy, RepeatsWhatStandsBehindItsIndexShifted) {
  EXPECT_EQ(ends_of("INDEX/1\nGOTO/1,0,5\nGOTO/2,0,5\nCOPY/1,TRANSL,10,0,-1,2\nGOTO/0,0,50"),
            (Ends{{1, 0, 5}, {2, 0, 5}, {11, 0, 4}, {12, 0, 4}, {21, 0, 3}, {22, 0, 3}, {0, 0, 50}}));
  EXPECT_EQ(ends_of("INDEX/1\nGOTO/1,0,5\nGOTO/2,0,5\nCOPY/1,SAME"),
            (Ends{{1, 0, 5}, {2, 0, 5}, {1, 0, 5}, {2, 0, 5}}));
  EXPECT_EQ(ends_of("UNITS/INCH\nINDEX/1\nGOTO/1,0,1\nCOPY/1,TRANSL,1,0,0"), (Ends{{25.4, 0, 25.4}, {50.8, 0, 25.4}}));
}

TEST(AptCopy, TurnsAboutTheOrigin) {
  EXPECT_EQ(ends_of("INDEX/1\nGOTO/1,0,5\nCOPY/1,XYROT,90,3"), (Ends{{1, 0, 5}, {0, 1, 5}, {-1, 0, 5}, {0, -1, 5}}));
  EXPECT_EQ(ends_of("MULTAX/ON\nINDEX/1\nGOTO/1,2,3\nCOPY/1,YZROT,90"), (Ends{{1, 2, 3}, {1, -3, 2}}));
  const auto moves = moves_of("MULTAX/ON\nINDEX/1\nGOTO/1,2,3,0,.6,.8\nCOPY/1,ZXROT,90");
  EXPECT_EQ(end_of(moves.at(1)), json({{"p", {3, 2, -1}}, {"axis", {0.8, 0.6, 0}}}));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nGOTO/1,2,3\nCOPY/1,YZROT,90")),
              StartsWith("6:1: the tool axis 0,-1,0 is not Z"));
}

TEST(AptCopy, TurnsArcsIncrementsAndTheirDirectionsWithIt) {
  const auto moves = moves_of(
      "INDEX/1\nRAPID\nGOTO/10,0,0\nINDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,0,10,0)\nGODLTA/0,-10,0\n"
      "COPY/1,XYROT,180");
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_EQ(moves[4]["params"]["StartPoint"]["p"], json({-10, 0, 0}));
  EXPECT_EQ(moves[4]["params"]["EndPoint"]["p"], json({0, -10, 0}));
  EXPECT_EQ(moves[4]["params"]["RotSign"], 1);
  EXPECT_EQ(end_of(moves[5])["p"], json({0, 0, 0}));
}

TEST(AptCopy, StandsWithinOthersAndIsNotShiftedByTransTwice) {
  EXPECT_EQ(ends_of("TRANS/0,0,100\nINDEX/1\nINDEX/2\nGOTO/1,0,0\nCOPY/2,TRANSL,1,0,0,1\nCOPY/1,TRANSL,0,10,0,1"),
            (Ends{{1, 0, 100}, {2, 0, 100}, {1, 10, 100}, {2, 10, 100}}));
}

TEST(AptCopy, KeepsTheLineOfEachStatement) {
  const auto moves = moves_of("INDEX/1\nGOTO/1,0,5\nCOPY/1,TRANSL,10,0,0\nGOTO/0,0,0");
  EXPECT_EQ(moves[0]["params"]["MoveID"], 6);
  EXPECT_EQ(moves[1]["params"]["MoveID"], 6);
  EXPECT_EQ(moves[2]["params"]["MoveID"], 8);
}

TEST(AptCopy, ThatIsNotWholeIsRefused) {
  EXPECT_THAT(refusal_of(program_of("COPY/1,SAME,1")), StartsWith("5:1: no INDEX/1 before this COPY"));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nGOTO/1,0,0\nCOPY/1,SAME,1\nCOPY/1,SAME,1")),
              StartsWith("8:1: no INDEX/1 before this COPY that has none yet"));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nGOTO/1,1,1")), StartsWith("5:1: INDEX/1 has no COPY"));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nINDEX/1")), HasSubstr("has no COPY yet"));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nCOPY/1,MODIFY,2")), HasSubstr("taken with SAME, TRANSL"));
  EXPECT_THAT(refusal_of(program_of("INDEX/1\nCOPY/1,SAME,1.5")), HasSubstr("whole number"));
  std::string open, empty;
  for (int i = 1; i < 10; ++i) open += fmt::format("INDEX/{}\n", i);
  EXPECT_THAT(refusal_of(program_of(open)), StartsWith("13:1: too many INDEX"));
  for (int i = 1; i < 8; ++i) empty = fmt::format("INDEX/{0}\n{1}COPY/{0},SAME,9999\n", i, empty);
  EXPECT_THAT(refusal_of(program_of(empty)), HasSubstr("repeats more than half a million statements"));
  std::string nested = "GOTO/1,0,0\nGOTO/0,0,0\n";
  for (int i = 1; i < 5; ++i) nested = fmt::format("INDEX/{0}\n{1}COPY/{0},SAME,9999\n", i, nested);
  EXPECT_THAT(refusal_of(program_of(nested)), HasSubstr("repeats more than half a million statements"));
}

TEST(AptMacro, IsCalledWithWhatItsParametersAre) {
  EXPECT_EQ(ends_of("HOLE=MACRO/X,Z=-5\nGOTO/X,0,0\nGOTO/X,0,Z\nTERMAC\nCALL/HOLE,X=3\nCALL/HOLE,Z=-7,X=4.5"),
            (Ends{{3, 0, 0}, {3, 0, -5}, {4.5, 0, 0}, {4.5, 0, -7}}));
  EXPECT_EQ(moves_of("M=MACRO\nGOTO/1,1,1\nTERMAC\n\nCALL/M")[0]["params"]["MoveID"], 6);
}

TEST(AptMacro, ThatIsNotWholeIsRefused) {
  EXPECT_THAT(refusal_of(program_of("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M")), StartsWith("8:1: X of M is not given"));
  EXPECT_THAT(refusal_of(program_of("M=MACRO/X\nGOTO/X,0,0\nTERMAC\nCALL/M,Y=1")),
              StartsWith("8:8: this is no parameter of M"));
  EXPECT_THAT(refusal_of(program_of("CALL/M")), HasSubstr("there is no macro M before this"));
  EXPECT_THAT(refusal_of("UNITS/MM\nM=MACRO\nGOTO/1,1,1\n"), HasSubstr("M does not end"));
  EXPECT_THAT(refusal_of(program_of("M=MACRO\nGOTO/1,1,1")), HasSubstr("FINI before the end of M"));
  EXPECT_THAT(refusal_of(program_of("TERMAC")), HasSubstr("without what it ends"));
  EXPECT_THAT(refusal_of(program_of("MACRO/X")), HasSubstr("a MACRO has a name"));
  EXPECT_THAT(refusal_of(program_of("M=MACRO\nCALL/M\nTERMAC\nCALL/M")), HasSubstr("a macro may call itself"));
}

TEST(AptSubprogram, IsCalledByItsNumber) {
  EXPECT_EQ(ends_of("DEFSUB/7\nGOTO/1,0,0\nGODLTA/1,0,0\nENDSUB\nCALSUB/7\nTRANS/0,5,0\nCALSUB/7"),
            (Ends{{1, 0, 0}, {2, 0, 0}, {1, 5, 0}, {2, 5, 0}}));
  EXPECT_THAT(refusal_of(program_of("CALSUB/7")), StartsWith("5:1: there is no DEFSUB/7 before this"));
}

TEST(AptSynonym, StandsForAWordOfTheLanguage) {
  EXPECT_EQ(ends_of("SYN/GT,GOTO,SP,SPINDL,RIGHT,CLW\nGT/1,2,3\nSP/100,RIGHT\ngt/4,5,6"), (Ends{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_THAT(refusal_of(program_of("SYN/GT")), StartsWith("5:1: SYN lacks the word that it stands for"));
  EXPECT_THAT(refusal_of(program_of("SYN/GT,GOTO,GT,FROM")), StartsWith("5:13: SYN: GT stands for something already"));
}

}  // namespace
}  // namespace rmac::apt
