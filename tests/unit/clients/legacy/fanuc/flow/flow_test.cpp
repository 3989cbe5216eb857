#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(FanucLoop, GoesOnWhileItsConditionHolds) {
  EXPECT_THAT(xs_of("#1=0\nWHILE [#1 LT 3] DO 1\n#1=#1+1\nG0 X#1\nEND 1"), ElementsAre(1, 2, 3));
  EXPECT_THAT(xs_of("WHILE[1 EQ 2]DO1\nG0 X1.\nEND1\nG0 X2."), ElementsAre(2));
  EXPECT_THAT(xs_of("#1=0\nDO1\n#1=#1+1\nIF[#1 GT 2]GOTO 9\nG0X#1\nEND1\nN9 G0 X9."), ElementsAre(1, 2, 9));
}

TEST(FanucLoop, StandsWithinOthers) {
  const std::string lines =
      "#1=0\nWHILE[#1LT2]DO1\n#2=0\nWHILE[#2LT2]DO2\n#3=0\nWHILE[#3LT1]DO3\nG0X[#1*10+#2+1.]\n#3=#3+1\nEND3\n#2=#2+"
      "1\nEND2\n"
      "#1=#1+1\nEND1\nWHILE[#1LT3]DO1\nG0X99.\n#1=#1+1\nEND1";
  EXPECT_THAT(xs_of(lines), ElementsAre(1, 2, 11, 12, 99));
}

/// In binary a sum of tenths is less than what it says; a control computes in decimals.
TEST(FanucLoop, CountsInTenths) {
  EXPECT_EQ(xs_of("#1=.1\nWHILE[#1LE1.]DO1\nG0X#1\n#1=#1+.1\nEND1").size(), 10U);
}

TEST(FanucLoop, IsRefusedWhereItIsNone) {
  EXPECT_THAT(refusal_of(program_of("WHILE[1 EQ 1]DO1")), HasSubstr("DO1 is not ended"));
  EXPECT_THAT(refusal_of(program_of("END1")), StartsWith("5:1: END1 without a DO1"));
  EXPECT_THAT(refusal_of(program_of("DO1\nDO2\nEND1\nEND2")), StartsWith("7:1: END1 where END2 is due"));
  EXPECT_THAT(refusal_of(program_of("DO1\nDO1\nEND1\nEND1")), StartsWith("6:1: DO1 within DO1"));
  EXPECT_THAT(refusal_of(program_of("DO4\nEND4")), HasSubstr("1, 2 or 3"));
  EXPECT_THAT(refusal_of(program_of("WHILE[1 EQ 1]\nEND1")), HasSubstr("DO and a number"));
  EXPECT_THAT(refusal_of(program_of("GOTO 5\nDO1\nN5 G0 X1.\nEND1")), StartsWith("5:1: N5 is within a loop"));
}

TEST(FanucLoop, StandsBehindACommentAndBehindAPercentSignThatIsLeftOut) {
  EXPECT_THAT(xs_of("#1=0\n(TWICE) WHILE[#1LT2]DO1\n#1=#1+1\nG0X#1\nN7 (END9) (AND) END1 (HERE)"), ElementsAre(1, 2));
  EXPECT_THAT(refusal_of(program_of("( ( ) DO1\nEND1")), StartsWith("5:1: a comment within this comment"));
  EXPECT_THAT(refusal_of("\t()\tDO"), StartsWith("1:7: a loop has the number"));
  Options options;
  options.block_delete = true;
  EXPECT_EQ(ends_of("#1=0\n/%\nWHILE[#1LT2]DO1\n#1=#1+1\nG0X#1\nEND1", options).size(), 2U);
}

TEST(FanucLoop, ThatNeverEndsIsEnded) {
  EXPECT_THAT(refusal_of(program_of("WHILE[1 EQ 1]DO1\nEND1")), HasSubstr("without a move"));
  EXPECT_THAT(refusal_of(program_of("N1 GOTO 1")), HasSubstr("without a move"));
  Options options;
  options.bounds.output_mb = 1;
  EXPECT_THAT(refusal_of(program_of("N1 G91 G0 X1.\nX-1.\nGOTO 1"), options), HasSubstr("more than 1 MB"));
}

TEST(FanucJump, GoesToTheNextLineOfThatNumberOrTheFirst) {
  EXPECT_THAT(xs_of("GOTO 7\nG0 X1.\nN7 G0 X2."), ElementsAre(2));
  EXPECT_THAT(xs_of("#1=0\nN7 #1=#1+1\nG0 X#1\nIF[#1LT3] GOTO 7"), ElementsAre(1, 2, 3));
  EXPECT_THAT(xs_of("#1=8\nGOTO #1\nN7 G0 X1.\nN8 G0 X2."), ElementsAre(2));
  EXPECT_THAT(xs_of("GOTO [7+1]\nN7 G0 X1.\n N 0008 G0 X2."), ElementsAre(2));
  EXPECT_THAT(refusal_of(program_of("GOTO 5")), StartsWith("5:1: there is no N5 in O1"));
  EXPECT_THAT(refusal_of(program_of("GOTO 5", "O2\nN5 M99\n")), HasSubstr("there is no N5"));
  EXPECT_THAT(refusal_of(program_of("GOTO 1.5")), HasSubstr("not to 1.5"));
  EXPECT_THAT(refusal_of(program_of("IF[1 EQ 1] G0 X1.")), HasSubstr("GOTO or THEN"));
  EXPECT_THAT(refusal_of(program_of("IF[#1] GOTO 5\nN5")), StartsWith("5:3: a condition compares"));
  EXPECT_THAT(xs_of("IF[[#1 EQ 1] OR [#2 EQ #0]] GOTO 5\nG0 X1.\nN5 X2."), ElementsAre(2));
}

TEST(FanucSubprogram, IsCalledInBothWaysOfWritingHowOften) {
  const std::string sub = "O1001\nG91 G0 X1.\nG90 M99\n";
  EXPECT_THAT(xs_of("M98 P1001", sub), ElementsAre(1));
  EXPECT_THAT(xs_of("M98 P1001 L3", sub), ElementsAre(1, 2, 3));
  EXPECT_THAT(xs_of("M98 P31001", sub), ElementsAre(1, 2, 3));
  EXPECT_THAT(xs_of("M98 P00021001", sub), ElementsAre(1, 2));
  EXPECT_THAT(xs_of("G0 X5. M98 P1001", sub), ElementsAre(5, 6));
  EXPECT_THAT(xs_of("M98 P31001", "O31001\nG0 X7.\nM99\n"), ElementsAre(7));
  EXPECT_THAT(refusal_of(program_of("M98 P31001", sub + "O31001\nM99\n")),
              HasSubstr("may be O31001, or O1001 3 times"));
  EXPECT_THAT(refusal_of(program_of("M98 P5")), StartsWith("5:1: O5 is not in this file"));
  EXPECT_THAT(refusal_of(program_of("M98")), HasSubstr("needs P"));
}

TEST(FanucSubprogram, ReturnsToWhereItIsTold) {
  EXPECT_THAT(xs_of("M98 P7\nG0 X1.\nN20 G0 X2.", "O7\nM99 P20\n"), ElementsAre(2));
  EXPECT_THAT(refusal_of(program_of("M99")), HasSubstr("the main program came to it"));
  EXPECT_THAT(xs_of("N5 #1=#1+1\nG0 X#1\nIF[#1GE3]GOTO 9\nM99 P5\nN9 G0 X9."), ElementsAre(1, 2, 3, 9));
  EXPECT_THAT(refusal_of(program_of("M99 P5")), StartsWith("5:1: there is no N5 in O1"));
}

TEST(FanucSubprogram, SharesVariablesAndAMacroDoesNot) {
  EXPECT_THAT(xs_of("#1=1.\nM98 P7\nG0 X#1", "O7\n#1=#1+1\nM99\n"), ElementsAre(2));
  EXPECT_THAT(xs_of("#1=1.\nG65 P7 A5.\nG0 X#1", "O7\nG0 X#1\n#1=8.\nM99\n"), ElementsAre(5, 1));
  EXPECT_THAT(xs_of("G65 P7 A5. L2", "O7\n#1=#1+1\nG0 X#1\nM99\n"), ElementsAre(6))
      << "each time with what was given: the same place";
  EXPECT_THAT(xs_of("G65 P7\nG0 X#100", "O7\n#100=4.\nM99\n"), ElementsAre(4));
}

TEST(FanucSubprogram, NestsAsDeepAsAControlDoes) {
  EXPECT_THAT(refusal_of(program_of("G65 P7", "O7\nG65 P7\nM99\n")), StartsWith("8:1: a macro within 4 others"));
  EXPECT_THAT(refusal_of(program_of("M98 P7", "O7\nM98 P7\nM99\n")), HasSubstr("a call within 14 others"));
  EXPECT_THAT(refusal_of(program_of("M98 P7", "O7\nG0 X1.\n")), HasSubstr("within O7, which M99 is to end"));
}

TEST(FanucModalCall, CallsBehindEachMove) {
  const std::string macro = "O7\nG91 G0 Z#26\nZ-#26\n#1=#1+1\nG90\nM99\n";
  const auto ends = ends_of("G66 P7 Z5. A0\nG0 X1.\nM8\nX2.\nG67\nX3.", {}, macro);
  EXPECT_THAT(ends,
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(1, 0, 15), ElementsAre(1, 0, 10), ElementsAre(2, 0, 10),
                          ElementsAre(2, 0, 15), ElementsAre(2, 0, 10), ElementsAre(3, 0, 10)));
  EXPECT_THAT(xs_of("G66 P7 A0.\nG0 Y1.\nG0 Y2.\nG67", "O7\n#1=#1+1\nG91 G1 X#1\nG90 M99\n"), ElementsAre(0, 1, 1, 3))
      << "its variables stay from call to call";
  EXPECT_THAT(refusal_of(program_of("G66 P7\nG66 P7", "O7\nM99\n")), HasSubstr("G66 within G66"));
}

TEST(FanucJump, OrASettingThatIsNotDueHasToBeOne) {
  for (const std::string rest : {"THEN #1=2 G0 X5.", "THEN #1=[2", "THEN #1 2", "THEN #1=FOO[2]", "GOTO 5 X1."}) {
    const std::string there = refusal_of(program_of("IF[1 EQ 1]" + rest + "\nN5"));
    EXPECT_THAT(there, StartsWith("5:")) << rest;
    EXPECT_EQ(refusal_of(program_of("IF[1 EQ 2]" + rest + "\nN5")), there) << rest;
  }
  EXPECT_EQ(refusal_of(program_of("#2=0\nIF[#2 NE 0]THEN #1=1/#2\nIF[#2 NE 0]THEN #1=#500\nIF[#2 NE 0]THEN #3000=1")),
            "taken");
}

TEST(FanucSubprogram, HasItsNumberBehindACommentToo) {
  EXPECT_THAT(xs_of("M98 P2", "(FIRST)\n(SIDE) O2\nG0 X2.\nM99\n"), ElementsAre(2));
}

TEST(FanucSubprogram, IsCalledOnceAtLeast) {
  EXPECT_THAT(refusal_of(program_of("M98 P7 L0", "O7\nM99\n")), StartsWith("5:8: L of M98"));
  EXPECT_THAT(refusal_of(program_of("G65 P7 L0", "O7\nM99\n")), StartsWith("5:8: L says how often"));
}

}  // namespace
}  // namespace rmac::fanuc
