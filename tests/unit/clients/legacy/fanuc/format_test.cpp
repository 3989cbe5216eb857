#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(FanucFormat, TakesWhatPostsWriteAroundAProgram) {
  const std::string body =
      "\n(T1 D=10.)\nN10 G21 G90 G94 G17 G49 G40 G80\nN15 G50 G69 G15 G67\nT1 M6\nG43 H1\nG0 G54 X1. Y2. Z3.;\n";
  for (const std::string head :
       {"%\nO1234 (PLATE)", "%\n:1234(PLATE)", "%\r\nO0001\r", "\n%\n\nO7", "O7", "%\nO0000(T)", "(NC)\n%\nO7"})
    EXPECT_EQ(imported(head + body + "M30\n%\nrest").requests.size(), 2U) << head;
  EXPECT_EQ(imported("G21 G0 X1. Y2. Z3.\nM30\n").requests.size(), 1U);
}

TEST(FanucFormat, EndsByASecondPercentSignAlone) {
  EXPECT_EQ(imported("%\nO1\nG21 G0 X1. Y2. Z3.\n%\n").requests.size(), 1U);
  EXPECT_THAT(refusal_of("%\nO1\nG21 G0 X1. Y2. Z3.\n"), HasSubstr("ends without its second %"));
  EXPECT_THAT(refusal_of("O1\nG21 G0 X1. Y2. Z3.\n"), HasSubstr("ends without M30"));
  EXPECT_THAT(refusal_of("O1\nG21 G0 X1. Y2. Z3.\n%\n"), StartsWith("3:1: a % in a program"));
}

TEST(FanucFormat, RefusesASecondProgramThatTheFirstRunsInto) {
  EXPECT_THAT(refusal_of("%\nO1\nG21 G0 X1. Y2. Z3.\nO2\nM30\n%\n"), StartsWith("4:1: O2 begins here"));
  EXPECT_THAT(refusal_of("%\nG21 G0 X1. Y2. Z3.\nO2\nM30\n%\n"), StartsWith("3:1: O2 begins here"));
  EXPECT_THAT(refusal_of("%\nO2\nO2\nM30\n%\n"), StartsWith("3:1: O2 begins a second time"));
}

TEST(FanucFormat, RefusesLengthsWithoutAPointUnlessAnOptionSaysWhatTheyCount) {
  EXPECT_THAT(refusal_of(program_of("G1 X5")), StartsWith("5:4: no decimal point"));
  EXPECT_THAT(refusal_of(program_of("G2 X1. I5")), HasSubstr("--whole-numbers"));
  EXPECT_THAT(refusal_of(program_of("G20\nG1 X1. F20")), StartsWith("6:8: no decimal point"));
  EXPECT_THAT(ends_of("G1 X0 Y-0 Z0 F600"), ElementsAre(ElementsAre(0, 0, 0)));
  Options units, increments;
  units.whole_numbers = gcode::WholeNumbers::Units;
  increments.whole_numbers = gcode::WholeNumbers::Increments;
  EXPECT_THAT(ends_of("G1 X5 Y2.", units), ElementsAre(ElementsAre(5, 2, 10)));
  EXPECT_THAT(ends_of("G1 X5 Y2.", increments), ElementsAre(ElementsAre(0.005, 2, 10)));
  EXPECT_THAT(ends_of("G20\nG1 X5 F10.", increments), ElementsAre(ElementsAre(0.0127, 0, 10)));
}

TEST(FanucFormat, LeavesOutBlocksBehindASlashWhereTheSwitchIsOn) {
  Options options;
  options.block_delete = true;
  EXPECT_THAT(ends_of("/G0 X1.\n/2 N5 G0 X2.\nG0 X3."),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(2, 0, 10), ElementsAre(3, 0, 10)));
  EXPECT_THAT(ends_of("/G0 X1.\n/2 N5 G0 X2.\nG0 X3.", options), ElementsAre(ElementsAre(3, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G0 X1. /Y2.")), StartsWith("5:8: block delete"));
}

TEST(FanucFormat, TakesSeveralCodesOfAMachineInABlock) {
  EXPECT_THAT(imported(program_of("M3 S500 M8\nM5 M9 M1")).methods,
              ElementsAre("MoveToPathTarget", "InTurn", "InTurn", "ProgramStop"));
  EXPECT_THAT(refusal_of(program_of("M3 M5 S9")), HasSubstr("one modal group"));
}

TEST(FanucFormat, PassesOverWhatTheMachineDoesOnlyWhereItIsToldSo) {
  EXPECT_THAT(refusal_of(program_of("M10")), StartsWith("5:1: M10 is a code of the machine's builder"));
  EXPECT_THAT(refusal_of(program_of("M19")), HasSubstr("to an angle"));
  EXPECT_THAT(refusal_of(program_of("M198 P5")), HasSubstr("another memory"));
  Options options;
  options.passed_m = {3, 10, 19};
  EXPECT_EQ(imported(program_of("M10\nM19"), options).requests.size(), 1U);
  EXPECT_EQ(imported(program_of("M3 S5"), options).requests.size(), 3U);  // what is known is done
}

TEST(FanucFormat, PassesOverWhatItPrints) {
  EXPECT_EQ(imported(program_of("POPEN\nDPRNT[HOLE*X#9[53]*[#8]]\nN5 BPRNT[ A ]\nPCLOS")).requests.size(), 1U);
}

TEST(FanucFormat, PassesOverHowFarAControlLooksAhead) {
  EXPECT_EQ(
      imported(program_of("G05.1 Q1\nG5.1 Q1 R5\nG05.1 Q0\nG08 P1\nG8 P0\nG05 P10000\nG5 P0\nG187 P3 E0.02\nG103 P1"))
          .requests.size(),
      1U);
  EXPECT_EQ(ends_of("G5.1 Q3 X0 Y0 Z0").size(), 0U);  // the axes that it is for, and no move
  EXPECT_THAT(refusal_of(program_of("G5.1 Q3 X5.")), StartsWith("5:9: X, Y and Z of G5.1 are 0"));
  EXPECT_THAT(refusal_of(program_of("G5.1 Q9")), HasSubstr("Q0 to Q3"));
  EXPECT_THAT(refusal_of(program_of("G8 P1 Q1")), HasSubstr("nothing in this block uses Q"));
}

TEST(FanucFormat, NamesWhatIsNoBlock) {
  EXPECT_THAT(refusal_of(program_of("G1 X1.,R2.")), StartsWith("5:7: corners that are rounded"));
  EXPECT_THAT(refusal_of(program_of("G1 X1. ; G1 X2.")), StartsWith("5:8: ; ends a block"));
  EXPECT_THAT(refusal_of(program_of("G1 X1. (OPEN")), HasSubstr("does not end on its line"));
  EXPECT_THAT(refusal_of(program_of("G1 X1. E5.")), HasSubstr("nothing in this block uses E"));
  EXPECT_THAT(refusal_of(program_of("G1 X1. X2.")), HasSubstr("two X words"));
  EXPECT_THAT(refusal_of(program_of("G7.1 C10.")), HasSubstr("G7.1"));
  EXPECT_THAT(refusal_of(program_of("G12345")), HasSubstr("there is no G12345 here"));
  EXPECT_THAT(refusal_of(program_of("DPRNT[HELLO")), StartsWith("5:6: what is printed stands in [ ]"));
  EXPECT_THAT(refusal_of(program_of("DPRNT")), StartsWith("5:6: what is printed stands in [ ]"));
  EXPECT_THAT(refusal_of(program_of("DPRNT[A] G1 X5.")), StartsWith("5:10: "));
  EXPECT_THAT(refusal_of(program_of("POPEN G1 X5.")), StartsWith("5:7: "));
  EXPECT_THAT(refusal_of(program_of("G1 X0 A90.")), HasSubstr("give --rotary"));
}

}  // namespace
}  // namespace rmac::fanuc
