// Subs and numbered programs, as LinuxCNC carries them out.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/flow/carried_out.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

TEST(Rs274Sub, IsCarriedOutWhereItIsCalledAlone) {
  EXPECT_THAT(carried_out("o1 sub\nX1\no1 endsub\nY1\no1 call\nY2\no1 call"), ElementsAre("Y1", "X1", "Y2", "X1"));
  EXPECT_THAT(carried_out("o<Bolt Circle> sub\nX1\no<boltcircle> endsub\nO<BOLTCIRCLE> CALL"), ElementsAre("X1"));
  EXPECT_THAT(carried_out("o1 call\nM2\no1 sub\nX1\no1 endsub"), ElementsAre("X1")) << "it may stand behind the end";
}

TEST(Rs274Sub, IsCalledByAComputedLabel) {
  EXPECT_THAT(carried_out("o101 sub\nX1\no101 endsub\no102 sub\nX2\no102 endsub\n#1=101\no[#1+1] call\no#1 call"),
              ElementsAre("X2", "X1"));
  EXPECT_THAT(carried_out("#1=7\no[#1+0.5] call").back(), StartsWith("2:2: 7.5 is no number of an O word"));
}

TEST(Rs274Sub, HasItsValuesInItsOwnParameters) {
  EXPECT_THAT(
      carried_out("#1=7 #3=9 #30=5\no1 sub\nX#1 Y#2 Z#3\n#1=50\no1 endsub\no1 call [#1+1] [2] (values)\nX#1 Y#3 Z#30"),
      ElementsAre("X8 Y2 Z0", "X7 Y9 Z5"))
      << "what is missing is 0, and the caller's are restored";
  EXPECT_THAT(carried_out("o1 sub\n#31=4\no1 endsub\no1 call\nX#31"), ElementsAre("X4"))
      << "from 31 on they are everybody's";
  EXPECT_THAT(carried_out("o1 sub\no1 endsub\no1 call [1]\nX#1").back(), StartsWith("4:2: #1 was not set before"))
      << "nothing is restored to nothing, not to 0";
  std::string thirty;
  for (int value = 1; value <= 30; ++value) thirty += fmt::format("[{}]", value);
  EXPECT_THAT(carried_out("o1 sub\nX#30\no1 endsub\no1 call" + thirty), ElementsAre("X30"));
  EXPECT_THAT(carried_out("o1 sub\nX#30\no1 endsub\no1 call" + thirty + "[31]").back(), HasSubstr("at most 30 values"));
}

TEST(Rs274Sub, HasNamesOfItsOwnButThoseThatBeginWithALine) {
  EXPECT_THAT(carried_out("#<a>=1 #<_g>=2\no1 sub\n#<a>=5\n#<_g>=6\nX#<a>\no1 endsub\no1 call\nX#<a> Y#<_g>"),
              ElementsAre("X5", "X1 Y6"));
  EXPECT_THAT(carried_out("#<a>=1\no1 sub\nX#<a>\no1 endsub\no1 call").back(),
              StartsWith("3:2: #<A> was not set before"));
  EXPECT_THAT(carried_out("o1 sub\nX[EXISTS[#<a>]]\n#<a>=1\no1 endsub\no1 call\no1 call"), ElementsAre("X0", "X0"));
}

TEST(Rs274Return, LeavesTheSubWithAValue) {
  EXPECT_THAT(
      carried_out(
          "X#<_value> Y#<_value_returned>\no1 sub\no2 repeat [9]\nX1\no1 return [#1*2]\no2 endrepeat\nX2\no1 endsub\n"
          "o1 call [4]\nX#<_value> Y#<_value_returned>"),
      ElementsAre("X0 Y0", "X1", "X8 Y1"));
  EXPECT_THAT(carried_out("o1 sub\no1 endsub [5]\no2 sub\nX#<_value>\no2 endsub\no1 call\nX#<_value>\no2 "
                          "call\nX#<_value> Y#<_value_returned>"),
              ElementsAre("X5", "X5", "X0 Y0"))
      << "it stays until the next return, in subs that are called too";
  EXPECT_THAT(carried_out("o1 sub\no1 endsub [5]\no2 sub\no1 call\no2 endsub\no2 call\nX#<_value> Y#<_value_returned>"),
              ElementsAre("X0 Y0"))
      << "so does a return without one";
  EXPECT_THAT(carried_out("#<_value>=3").back(), HasSubstr("what the last sub gave back"));
}

TEST(Rs274Sub, CallsItselfNineDeep) {
  const std::string program = "o1 sub\nX#1\no2 if [#1 lt {}]\no1 call [#1+1]\no2 endif\nY#1\no1 endsub\no1 call [1]";
  const auto nine = carried_out(fmt::format(fmt::runtime(program), 9));
  EXPECT_THAT(nine, SizeIs(18));
  EXPECT_EQ(nine.back(), "Y1");
  EXPECT_THAT(carried_out(fmt::format(fmt::runtime(program), 10)).back(), StartsWith("4:1: a call within 9 others"));
}

TEST(Rs274Sub, IsRefusedWhereItIsNotWholeOrNotThere) {
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"o<pocket> call [1]", "1:1: o<pocket> is not in this file, and no other is read; write o<pocket> sub"},
      {"o1 sub\no2 sub\no2 endsub\no1 endsub\no1 call", "2:1: o2 sub within o1 sub of line 1"},
      {"o1 if [1]\no2 sub\no2 endsub\no1 endif", "2:1: o2 sub within o1 if"},
      {"o1 sub\nX1", "1:1: o1 sub is not closed; write o1 endsub"},
      {"o1 sub\no2 endsub", "2:1: o2 endsub does not belong"},
      {"o1 sub\no1 endsub\no1 sub\no1 endsub", "3:1: o1 is defined in line 1 already"},
      {"o1 sub\no1 endsub\no1 return\no1 call", "3:1: o1 return stands in no sub"},
      {"o1 return [3]", "1:1: o1 return stands in no sub"},
      {"#1=1\no#1 sub\no#1 endsub", "2:1: what is called later has a number or a name"},
      {"o1 while [1]\no2 sub\no1 break\no2 endsub\no1 endwhile", "2:1: o2 sub within o1 while"},
      {"o1 sub\no1 endsub\no1 call [1] 2", "3:13: nothing but a comment"},
      {"o1 sub\no1 endsub [1] 2\no1 call", "2:15: nothing but a comment"},
      {"M2\no1 sub", ""},
  };
  for (const auto& [program, message] : wrong) {
    const auto done = carried_out(program);
    EXPECT_THAT(done.empty() ? "" : done.back(), StartsWith(message)) << program;
  }
}

// LinuxCNC's own examples give it the label of the condition that it stands in.
TEST(Rs274Sub, IsLeftByAReturnOfAnyLabel) {
  EXPECT_THAT(carried_out("o1 sub\no2 if [#1 GT 0]\no2 return [#1*2]\no2 endif\nX9\no3 return\nX8\no1 endsub\n"
                          "o1 call [4]\nY#<_value>\no1 call [0]\nY#<_value>"),
              ElementsAre("Y8", "X9", "Y0"));
}

TEST(Rs274NumberedProgram, IsCalledByM98AsOftenAsLSays) {
  const std::string program = "O1 (main)\nM98 P100\nY1\nM98 P100 L3\nM98 P0100 L0\nM2\nO100\nX1\nM99";
  EXPECT_THAT(carried_out(program), ElementsAre("X1", "Y1", "X1", "X1", "X1"));
}

TEST(Rs274NumberedProgram, SharesNumbersButNoNames) {
  EXPECT_THAT(carried_out("#1=1 #<a>=2\nM98 P7 L2\nX#1 Y#<a>\nM2\nO7\nX[EXISTS[#<a>]]\n#<a>=9\n#1=[#1+1]\nM99"),
              ElementsAre("X0", "X0", "X3 Y2"));
}

TEST(Rs274NumberedProgram, CallsOthersAndSubs) {
  EXPECT_THAT(carried_out("o5 sub\nZ#1\no5 endsub\n#1=0\nM98 P1 L2\nM2\nO1\nM98 P2 L2\no5 call [7]\nM99\nO2\nX1\nM99"),
              ElementsAre("X1", "X1", "Z7", "X1", "X1", "Z7"));
}

TEST(Rs274NumberedProgram, IsRefusedWhereItIsNotWholeOrNotThere) {
  EXPECT_THAT(carried_out("M98 P5\nM2").back(), StartsWith("1:1: O5 is not in this file"));
  EXPECT_THAT(carried_out("o5 sub\no5 endsub\nM98 P5").back(), StartsWith("3:1: o5 is a sub; call it by o5 call"));
  EXPECT_THAT(carried_out("o5 call\nM2\nO5\nM99").back(),
              StartsWith("1:1: o5 is a numbered program; call it by M98 P5"));
  EXPECT_THAT(carried_out("X1\nO5\nX2\nM99").back(),
              StartsWith("4:1: M99 ends a numbered program that M98 called; here"));
  EXPECT_THAT(carried_out("o5 sub\nM99\no5 endsub\no5 call").back(),
              StartsWith("2:1: M99 ends a numbered program; a sub"));
  EXPECT_THAT(carried_out("M98 P5\nM2\nO5\nX1\nO6\nX2\nM99").back(), StartsWith("5:1: o6 begins here while o5 runs"));
  EXPECT_THAT(carried_out("M98 P5\nM2\nO5\nM98 P5\nM99").back(), StartsWith("4:1: a call within 9 others"));
  EXPECT_THAT(carried_out("M98 P5 L1000000\nM2\nO5\nM99").back(), StartsWith("4:1: 1000 lines were carried out"));
}

}  // namespace
}  // namespace rmac::rs274
