#include <gmock/gmock.h>

#include "clients/legacy/apt/statements/scanner.hpp"
#include "unit/clients/legacy/apt/imported.hpp"

namespace rmac::apt {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A statement as its parts, one behind the other.
std::string read(const std::string& text) {
  Scanner scanner(text);
  std::string parts;
  for (Statement statement; scanner.next(statement);) {
    parts +=
        fmt::format("{}:{}{}", statement.line, statement.name.empty() ? "" : statement.name + "=", statement.major);
    if (statement.is_text) parts += "'" + statement.text + "'";
    for (const Element& element : statement.elements) {
      parts += element.kind == Element::Kind::Number ? fmt::format(" {}", element.value) : " " + element.word;
    }
    parts += ";";
  }
  return parts;
}

TEST(AptStatement, HasItsMajorWordItsWordsAndNumbers) {
  EXPECT_EQ(read("GOTO/1,2,-3"), "1:GOTO 1 2 -3;");
  EXPECT_EQ(read("RAPID/\nGOTO/1,,2"), "1:RAPID;2:GOTO 1  2;");
  EXPECT_EQ(read("RAPID\nSPINDL/RPM,2000,CLW\n"), "1:RAPID;2:SPINDL RPM 2000 CLW;");
  EXPECT_EQ(read("TLON,GOFWD/(CIRCLE/0,0,0,5),ON"), "1:TLON,GOFWD CIRCLE ON;");
  EXPECT_EQ(read("TOOLNO/1,,,2"), "1:TOOLNO 1   2;");
}

TEST(AptStatement, ReadsNumbersAsTheyAreWritten) {
  EXPECT_EQ(read("GOTO/1.,.5,-1.E-3,+2,1.5E+2,- 7"), "1:GOTO 1 0.5 -0.001 2 150 -7;");
}

TEST(AptStatement, TakesSmallLettersAndBlanksAnywhereButInNumbers) {
  EXPECT_EQ(read("  go to  /  1 ,\t2 , 3 \r\n"), "1:GOTO 1 2 3;");
  EXPECT_THAT(refusal_of("UNITS/MM\nGOTO/1 2 3\n"), StartsWith("2:8: a blank within a number; a comma may be missing"));
}

TEST(AptStatement, GoesOnBehindADollarAndOverComments) {
  EXPECT_EQ(read("GOTO/1,$\n 2,$ this is a remark\n$$ so is this\n3\nRAPID"), "1:GOTO 1 2 3;5:RAPID;");
  EXPECT_EQ(read("GOTO/1,2,3 $$ behind it\nRAPID"), "1:GOTO 1 2 3;2:RAPID;");
  EXPECT_THAT(refusal_of("GOTO/1,2,$\n"), StartsWith("1:11: the statement goes on ($), but the program ends"));
}

TEST(AptStatement, GoesOnOnlyBehindADollarOfItsOwn) {
  EXPECT_EQ(read("RAPID $$ said $\nSTOP"), "1:RAPID;2:STOP;");
  EXPECT_EQ(read("GOTO/1,$x\n2,3"), "1:GOTO 1 2 3;");
  EXPECT_EQ(read("GOTO/1,$\n2,$\n3\nSTOP"), "1:GOTO 1 2 3;4:STOP;");
  EXPECT_EQ(read("RAPID $$\nSTOP"), "1:RAPID;2:STOP;");
}

TEST(AptStatement, HasHyphensBetweenLettersAlone) {
  EXPECT_EQ(read("END-OF-PATH"), "1:END-OF-PATH;");
  EXPECT_EQ(read("X/A-B,-5,C"), "1:X A-B -5 C;");
  EXPECT_THAT(refusal_of("UNITS/MM\nRAPID-"), HasSubstr("- is not understood here"));
  EXPECT_THAT(refusal_of("UNITS/MM\nRAPID-5"), HasSubstr("- is not understood here"));
}

TEST(AptStatement, MayBeLongerThanCardsWere) {
  EXPECT_EQ(read("GOTO/" + std::string(90, ' ') + "1,2,3"), "1:GOTO 1 2 3;");
}

TEST(AptStatement, OfTextIsItsLineWhateverItHolds) {
  EXPECT_EQ(read("PARTNO a plate, 5$\npprint it costs $$ 5 / piece\nREMARK"),
            "1:PARTNO'a plate, 5$';2:PPRINT'it costs $$ 5 / piece';3:REMARK'';");
  EXPECT_EQ(read("TPRINT/T1 End Mill,,$\n D 10\nTOOL PATH/A-1.b,TOOL,M_10"),
            "1:TPRINT'T1 End Mill,,D 10';3:TOOLPATH'A-1.b,TOOL,M_10';");
  EXPECT_EQ(read("$$-> CSYS / 1., 0., $\n 2., 3.\nRAPID"), "1:$$'-> CSYS / 1., 0., 2., 3.';3:RAPID;");
  EXPECT_EQ(read("$$ it costs 5 $\nRAPID"), "1:$$'it costs 5 $';2:RAPID;");
  EXPECT_EQ(read("END-OF-PATH"), "1:END-OF-PATH;");
}

TEST(AptStatement, MayHaveALabelOrAName) {
  EXPECT_EQ(read("L1) GOTO/1,2,3\nM=MACRO/A,B=2"), "1:GOTO 1 2 3;2:M=MACRO A B;");
}

TEST(AptStatement, IsRefusedWithLineAndColumn) {
  EXPECT_THAT(refusal_of("UNITS/MM\n\n  GOTO/1,2,#\n"), StartsWith("3:12: # is not understood here"));
  EXPECT_THAT(refusal_of("RAPID; GOTO/1,2,3"), StartsWith("1:6: ; is not understood here"));
  EXPECT_THAT(refusal_of("TLON,GOFWD/(CIRCLE/1,2"), StartsWith("1:23: a ) is missing here"));
  EXPECT_THAT(refusal_of("UNITS/MM\nGOTO/1,2,1E999"), StartsWith("2:10: this is no number"));
  EXPECT_THAT(refusal_of("1GOTO/1"), HasSubstr("begins with a word"));
  EXPECT_THAT(refusal_of("X/((((((((((("), HasSubstr("begins with a word"));
  std::string deep = "X/";
  for (int i = 0; i < 1000; ++i) deep += "(A/";
  EXPECT_THAT(refusal_of(deep), HasSubstr("nested too deep"));
}

TEST(AptStatement, ThatIsNotUnderstoodStopsTheImport) {
  EXPECT_THAT(refusal_of(program_of("ROTABL/90,CLW")), StartsWith("5:1: ROTABL is not understood"));
  EXPECT_THAT(refusal_of(program_of("INSERT G0 Z0")), StartsWith("5:1: INSERT is not understood"));
  EXPECT_THAT(refusal_of(program_of("P1=POINT/1,2,3")), HasSubstr("import its CL file"));
  EXPECT_THAT(refusal_of(program_of("GOTO/1,2,3,4")), HasSubstr("which are 3 or 6 numbers, and here are 4"));
  EXPECT_THAT(refusal_of(program_of("GOTO/1,2,X")), HasSubstr("here are 2"));
  EXPECT_THAT(refusal_of(program_of("GOTO/1,2,3,0,0,1,IN")), StartsWith("5:18: GOTO: IN is not understood here"));
}

TEST(AptStatement, ThatDescribesOrPrintsChangesNothing) {
  const std::string lines =
      "AUTOPS\nCUTTER/10,2,3\nINTOL/.01\nOUTTOL/.01\nPARTNO x\nREMARK "
      "x\nMACHIN/FANUC.15M,1\nTLDATA/MILL,10\nPAINT/PATH\n"
      "PPRINT x\nTPRINT/x\nMODE/MILL\nARCSLP/ON\nCUTCOM/OFF\nOPSKIP/OFF\nREWIND/0\nORIGIN/0,0,0\n$$ x\nTITLES "
      "x\nSEQNO/10";
  EXPECT_THAT(imported(program_of(lines)).methods, ElementsAre("MoveToPathTarget"));
}

}  // namespace
}  // namespace rmac::apt
