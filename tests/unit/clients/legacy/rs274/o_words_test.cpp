// O words through the import: which moves they become, and where they are refused.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

TEST(Rs274Loop, HasTheMovesOfALineShareItsMoveID) {
  const auto done = imported(program_of("o1 repeat [3]\nG1 X1\nX0\no1 endrepeat"));
  std::vector<int> ids;
  for (const auto& request : done.requests) {
    if (request["params"].contains("EndPoint")) ids.push_back(request["params"]["MoveID"]);
  }
  EXPECT_THAT(ids, ElementsAre(4, 5, 4, 5, 4, 5));
}

/// A grid of holes, as somebody writes it by hand: a sub with values, computed coordinates, and a cycle within.
TEST(Rs274Sub, DrillsAGrid) {
  const auto ends = ends_of(
      "o<grid> sub (columns, rows, pitch)\n"
      "  #<row> = 0\n"
      "  o101 while [#<row> lt #2]\n"
      "    #<column> = 0\n"
      "    o102 while [#<column> lt #1]\n"
      "      G81 X[#<column> * #3] Y[#<row> * #3] Z-1 R1\n"
      "      #<column> = [#<column> + 1]\n"
      "    o102 endwhile\n"
      "    #<row> = [#<row> + 1]\n"
      "  o101 endwhile\n"
      "  G80\n"
      "o<grid> endsub [#1 * #2]\n"
      "G99\n"
      "o<grid> call [3] [2] [10]\n"
      "G0 X#<_value>");
  std::vector<std::vector<double>> holes;
  for (const auto& end : ends) {
    if (end[2] == -1) holes.push_back(end);
  }
  EXPECT_THAT(holes, ElementsAre(ElementsAre(0, 0, -1), ElementsAre(10, 0, -1), ElementsAre(20, 0, -1),
                                 ElementsAre(0, 10, -1), ElementsAre(10, 10, -1), ElementsAre(20, 10, -1)));
  EXPECT_EQ(ends.back()[0], 6);
}

TEST(Rs274NumberedProgram, StandsAloneInItsBlock) {
  const std::string sub = "\nM2\nO7\nG1 X1\nM99";
  EXPECT_EQ(ends_of("M98 P7 L2 (twice)" + sub).size(), 1U) << "the second ends where it begins";
  EXPECT_THAT(refusal_of(program_of("G1 X5 M98 P7" + sub)), StartsWith("3:7: M98 has a block of its own"));
  EXPECT_THAT(refusal_of(program_of("X5 M98 P7" + sub)), StartsWith("3:1: nothing in this block uses X"));
  EXPECT_THAT(refusal_of(program_of("M98" + sub)), StartsWith("3:1: M98 needs P"));
  EXPECT_THAT(refusal_of(program_of("M98 P7.5" + sub)), StartsWith("3:5: P of M98 is the number"));
  EXPECT_THAT(refusal_of(program_of("M98 P7 L-1" + sub)), StartsWith("3:8: L of M98 says how often"));
  EXPECT_THAT(refusal_of(program_of("M98 P7 L2.5" + sub)), StartsWith("3:8: L of M98 says how often"));
  EXPECT_THAT(refusal_of(program_of("M98 M2 P7" + sub)), StartsWith("3:5: M98 and M2 are of one modal group"));
  EXPECT_THAT(refusal_of(program_of("M98 P7\nM2\nO7\nM99 P3")), StartsWith("6:5: nothing in this block uses P"));
}

TEST(Rs274Program, IsRefusedWhereItEndsWithinAnother) {
  EXPECT_THAT(refusal_of("G21 G0 X0 Y0 Z0\nM98 P7\nM2\nO7\nG0 X1"),
              StartsWith("5:6: the file ends within o7, which M99 is to end"));
  EXPECT_THAT(refusal_of("%\nG21 G0 X0 Y0 Z0\nM98 P7\nM2\nO7\nG0 X1\n%"), StartsWith("7:1: the file ends within o7"));
  EXPECT_EQ(
      imported("%\nO1\nG21 G0 X0 Y0 Z0\nM98 P7\nM30\nO7\nG0 X1\nM99\n%\no2 nothing that is read\n").requests.size(),
      2U);
}

TEST(Rs274Program, MayEndWithinASubOrLoop) {
  EXPECT_EQ(imported("G21 G0 X0 Y0 Z0\no1 sub\nM2\no1 endsub\no1 call\nG0 X1\nM2\n").requests.size(), 1U);
  EXPECT_EQ(imported("G21 G0 X0 Y0 Z0\no1 while [1]\nM2\no1 endwhile\n").requests.size(), 1U);
}

TEST(Rs274Loop, IsEndedWhereItBecomesTooLong) {
  EXPECT_THAT(refusal_of(program_of("o1 while [1]\nG1 X1\nX0\no1 endwhile"), {.bounds = {.output_mb = 1}}),
              StartsWith("6:1: the program became more than 1 MB here"));
  EXPECT_THAT(refusal_of(program_of("o1 while [1]\nG4 P0\no1 endwhile"), {.bounds = {.idle_lines = 100}}),
              StartsWith("5:1: 100 lines were carried out without a move"));
  std::string plain;
  for (int line = 0; line < 6000; ++line) plain += "G1 X1\nX0\n";
  EXPECT_EQ(ends_of(plain, {.bounds = {.output_mb = 1}}).size(), 12000U) << "what has no loop is as long as it is";
}

TEST(Rs274Sub, IsRefusedInItsOwnLine) {
  EXPECT_THAT(refusal_of(program_of("o1 call\nM2\no1 sub\nG0 X1 X2\no1 endsub")), StartsWith("6:7: two X words"));
}

}  // namespace
}  // namespace rmac::rs274
