#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// X of a macro's move to one of its own variables, or -1 where that is vacant.
double own(const std::string& words, int number) {
  const std::string variable = "#" + std::to_string(number);
  const auto xs = xs_of("G65 P9000 " + words,
                        "O9000\nIF [" + variable + " EQ #0] THEN " + variable + "=-1\nG0 X" + variable + "\nM99\n");
  return xs.empty() ? 0 : xs.back();
}

TEST(FanucArguments, OfTheFirstKindHaveALetterEach) {
  const std::vector<std::pair<char, int>> kOf{{'A', 1},  {'B', 2},  {'C', 3},  {'D', 7},  {'E', 8},  {'F', 9},
                                              {'H', 11}, {'I', 4},  {'J', 5},  {'K', 6},  {'M', 13}, {'Q', 17},
                                              {'R', 18}, {'S', 19}, {'T', 20}, {'U', 21}, {'V', 22}, {'W', 23},
                                              {'X', 24}, {'Y', 25}, {'Z', 26}};
  for (const auto& [letter, number] : kOf) EXPECT_EQ(own(std::string(1, letter) + "3.", number), 3) << letter;
  EXPECT_EQ(own("A3.", 2), -1);
}

TEST(FanucArguments, OfTheSecondKindAreSets) {
  const std::string words = "A9. I1. J2. K3. I4. J5. K6. K7.";
  EXPECT_EQ(own(words, 4), 1);
  EXPECT_EQ(own(words, 6), 3);
  EXPECT_EQ(own(words, 7), 4);
  EXPECT_EQ(own(words, 9), 6);
  EXPECT_EQ(own(words, 12), 7);
  EXPECT_EQ(own("I1. K3. I4.", 7), 4);
  EXPECT_EQ(own("I1. I4. D5.", 7), 5);  // the later one counts
  EXPECT_EQ(own("I1. D5. I4.", 7), 4);
  std::string ten;
  for (int set = 0; set < 10; ++set) ten += "I1. J1. K8. ";
  EXPECT_EQ(own(ten, 33), 8);
  EXPECT_THAT(refusal_of(program_of("G65 P1 " + ten + "I1.")), HasSubstr("more than ten sets"));
}

TEST(FanucArguments, CountWithoutAPointWhereTheyAreNoLengths) {
  EXPECT_EQ(own("H6 S500 T3 M1 D2", 11), 6);
  EXPECT_THAT(refusal_of(program_of("G65 P9000 X10")), StartsWith("5:11: no decimal point"));
}

// As words of moves do: thousandths of a mm or degree, ten-thousandths of an inch.
TEST(FanucArguments, CountInIncrementsWhereTheProgramDoes) {
  Options increments;
  increments.whole_numbers = gcode::WholeNumbers::Increments;
  const auto x_mm = [&](const std::string& unit, const std::string& word, int number) {
    const std::string macro = "O9000\nG0 X[#" + std::to_string(number) + "*1000.]\nM99\n";
    return ends_of(unit + " G65 P9000 " + word, increments, macro).back().at(0);
  };
  EXPECT_NEAR(x_mm("G21\n", "X10", 24), 10, 1e-9);
  EXPECT_NEAR(x_mm("G20\n", "X10", 24), 1 * 25.4, 1e-9);
  EXPECT_NEAR(x_mm("G21\n", "X10.", 24), 10'000, 1e-9);
  EXPECT_NEAR(x_mm("G21\n", "F10", 9), 10'000, 1e-9) << "F in mm a minute needs no point";
  EXPECT_NEAR(x_mm("G20\n", "H10", 11), 10'000 * 25.4, 1e-9) << "a number of something";
}

TEST(FanucArguments, AreRefusedWhereTheyAreNone) {
  EXPECT_THAT(refusal_of(program_of("G65 A1.")), HasSubstr("need P"));
  EXPECT_THAT(refusal_of(program_of("G65 P9000 A1. A2.")), HasSubstr("two A words"));
  EXPECT_THAT(refusal_of(program_of("G65 P9000 G0")), HasSubstr("another G code"));
  EXPECT_THAT(refusal_of(program_of("G65 P9000 N5")), HasSubstr("stands at its begin"));
  EXPECT_THAT(refusal_of(program_of("G0 X1. G65 P9000")), HasSubstr("begin of its block"));
  EXPECT_THAT(refusal_of(program_of("G65 P9000")), StartsWith("5:1: O9000 is not in this file"));
}

}  // namespace
}  // namespace rmac::fanuc
