#include <gmock/gmock.h>

#include <cmath>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Rs274Expression, OperatorsBindAsInLinuxCnc) {
  EXPECT_EQ(value_of("[2 + 3 * 4]"), 14);
  EXPECT_EQ(value_of("[2 * 3 ** 2]"), 18);
  EXPECT_EQ(value_of("[2 ** 3 ** 2]"), 64);  // the left one first
  EXPECT_EQ(value_of("[-2 ** 2]"), 4);       // the sign is the number's
  EXPECT_EQ(value_of("[1 + 2 EQ 3]"), 1);
  EXPECT_EQ(value_of("[1 OR 0 AND 0]"), 0);  // of one level
  EXPECT_EQ(value_of("[2 GT 1 AND 0 EQ 0]"), 1);
  EXPECT_EQ(value_of("[9 - 3 - 2]"), 4);
}

TEST(Rs274Expression, ModIsNeverNegative) {
  EXPECT_EQ(value_of("[-7 MOD 3]"), 2);
  EXPECT_EQ(value_of("[7 MOD -3]"), 1);
}

TEST(Rs274Expression, FunctionsHaveDegreesAndRoundAsTheReport) {
  EXPECT_EQ(value_of("SIN[30]"), 0.5);
  EXPECT_EQ(value_of("ATAN[1]/[-1]"), 135);
  EXPECT_EQ(value_of("ACOS[0]"), 90);
  EXPECT_EQ(value_of("FIX[-2.5]"), -3);
  EXPECT_EQ(value_of("FUP[-2.5]"), -2);
  EXPECT_EQ(value_of("ROUND[-2.5]"), -3);
  EXPECT_EQ(value_of("LN[EXP[3]]"), 3);
  EXPECT_EQ(value_of("-SQRT[16]"), -4);
}

TEST(Rs274Expression, ComparisonsGiveOneOrZero) {
  for (int a = -2; a <= 2; ++a) {
    for (int b = -2; b <= 2; ++b) {
      const auto compared = [&](const char* word) {
        return value_of("[" + std::to_string(a) + word + std::to_string(b) + "]");
      };
      EXPECT_EQ(compared("EQ"), a == b);
      EXPECT_EQ(compared("NE"), a != b);
      EXPECT_EQ(compared("LT"), a < b);
      EXPECT_EQ(compared("LE"), a <= b);
      EXPECT_EQ(compared("GT"), a > b);
      EXPECT_EQ(compared("GE"), a >= b);
      EXPECT_EQ(compared("XOR"), (a != 0) != (b != 0)) << a << " " << b;
    }
  }
}

TEST(Rs274Parameter, IsSetWhenAllOfItsBlockWasRead) {
  EXPECT_EQ(value_of("#3", "#3=6\n#3=15 G0 X#3\n"), 15);
  EXPECT_EQ(ends_of("#3=6\n#3=15 G0 X#3").back().at(0), 6);
}

TEST(Rs274Parameter, HasANumberOrANameOfAnyCase) {
  EXPECT_EQ(value_of("#<Hole Depth>", "#<holedepth>=7\n"), 7);
  EXPECT_EQ(value_of("##1", "#1=2 #2=9\n"), 9);
  EXPECT_EQ(value_of("EXISTS[#<a>]"), 0);
  EXPECT_EQ(value_of("EXISTS[#<a>]", "#<a>=0\n"), 1);
  EXPECT_EQ(value_of("#5421", "G0 Y4\n"), 4);  // where the tool is
}

TEST(Rs274Parameter, IsRefusedWhereNothingSetIt) {
  EXPECT_THAT(refusal_of(program_of("G0 X#7")), StartsWith("3:5: #7 was not set before"));
  EXPECT_THAT(refusal_of(program_of("G0 X#<w>")), HasSubstr("#<W> was not set before"));
  // In the unit of the machine, and kept while G92.2 suspends them.
  for (const char* number : {"#5211", "#5213", "#5221", "#5383"}) {
    EXPECT_THAT(
        refusal_of(program_of(fmt::format("G10 L2 P1 X1 Y2 Z3\nG0 X0 Y0 Z9\nG92 X1 Y1 Z1\nG92.2\nG0 X{}", number))),
        StartsWith("7:5: "))
        << number;
  }
  EXPECT_THAT(refusal_of(program_of("#5221=3")), HasSubstr("the control's own"));
  EXPECT_THAT(refusal_of(program_of("G0 X#5161")), HasSubstr("not known here"));
  EXPECT_THAT(refusal_of(program_of("G0 X#9999")), HasSubstr("there is no parameter"));
}

TEST(Rs274Expression, IsRefusedWhereItHasNoValue) {
  EXPECT_THAT(refusal_of(program_of("G0 X[1 / 0]")), StartsWith("3:8: a division by zero"));
  EXPECT_THAT(refusal_of(program_of("G0 X[SQRT[-1]]")), HasSubstr("square root"));
  EXPECT_THAT(refusal_of(program_of("G0 X[-8 ** 0.5]")), HasSubstr("no such power"));
  EXPECT_THAT(refusal_of(program_of("G0 X[EXP[999]]")), HasSubstr("too large"));
  EXPECT_THAT(refusal_of(program_of("G0 X[1 + 2")), StartsWith("3:11: an operator or ] expected"));
  EXPECT_THAT(refusal_of(program_of("G0 X" + std::string(100'000, '['))), HasSubstr("nested more than"));
}

}  // namespace
}  // namespace rmac::rs274
