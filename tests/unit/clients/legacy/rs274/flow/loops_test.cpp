// Loops and conditions, as LinuxCNC carries them out.
#include <gmock/gmock.h>

#include <random>

#include "unit/clients/legacy/rs274/flow/carried_out.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

TEST(Rs274Repeat, RoundsItsNumberAndAHalfToTheEvenSide) {
  for (const auto& [number, times] :
       {std::pair{"2.6", 3U}, {"2.5", 2U}, {"3.5", 4U}, {"2.4", 2U}, {"1", 1U}, {"0.5", 0U}, {"0", 0U}, {"-2.5", 0U}}) {
    EXPECT_THAT(carried_out(fmt::format("o1 repeat [{}]\nX1\no1 endrepeat", number)), SizeIs(times)) << number;
  }
}

TEST(Rs274Repeat, CountsAnewEachTimeItBegins) {
  EXPECT_THAT(carried_out("o1 repeat [3]\no2 repeat [2]\nX1\no2 endrepeat\nY1\no1 endrepeat"),
              ElementsAre("X1", "X1", "Y1", "X1", "X1", "Y1", "X1", "X1", "Y1"));
  EXPECT_THAT(
      carried_out("#1=0\no1 while [#1 lt 2]\n#1=[#1+1]\no2 repeat [5]\nX#1\no1 continue\no2 endrepeat\no1 endwhile\n"
                  "o2 repeat [2]\nY1\no2 endrepeat"),
      ElementsAre("X1", "X2", "Y1", "Y1"))
      << "a repeat that was left in the middle is not gone on with";
}

TEST(Rs274While, TestsBeforeEachRound) {
  EXPECT_THAT(carried_out("#1=0\no1 while [#1 lt 3]\nX#1\n#1=[#1+1]\no1 endwhile\nY#1"),
              ElementsAre("X0", "X1", "X2", "Y3"));
  EXPECT_THAT(carried_out("o<never> while [0]\nX1\no<never> endwhile\nY1"), ElementsAre("Y1"));
}

TEST(Rs274Do, TestsBehindEachRound) {
  EXPECT_THAT(carried_out("#1=5\no1 do\nX#1\n#1=[#1+1]\no1 while [#1 lt 7]\nY1"), ElementsAre("X5", "X6", "Y1"));
  EXPECT_THAT(carried_out("o1 do\nX1\no1 while [0]"), ElementsAre("X1"));
  EXPECT_THAT(carried_out("#1=0\no1 do\no2 while [#1 lt 2]\nX#1\n#1=[#1+1]\no2 endwhile\no1 while [0]\nY1"),
              ElementsAre("X0", "X1", "Y1"))
      << "a while of another label begins a loop";
}

TEST(Rs274Break, LeavesTheLoopOfItsLabel) {
  EXPECT_THAT(carried_out("o1 while [1]\no2 while [1]\nX1\no1 break\no2 endwhile\nX2\no1 endwhile\nY1"),
              ElementsAre("X1", "Y1"));
  EXPECT_THAT(carried_out("o1 do\nX1\no2 if [1]\no1 break\no2 endif\nX2\no1 while [1]\nY1"), ElementsAre("X1", "Y1"));
}

TEST(Rs274Continue, GoesToTheTestOfTheLoop) {
  EXPECT_THAT(
      carried_out("#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\nX#1\no1 endwhile"),
      ElementsAre("X1", "X3"));
  EXPECT_THAT(
      carried_out("#1=0\no1 do\n#1=[#1+1]\no2 if [#1 ge 2]\no1 continue\no2 endif\nX#1\no1 while [#1 lt 4]\nY#1"),
      ElementsAre("X1", "Y4"));
}

TEST(Rs274If, CarriesOutTheFirstPartThatHolds) {
  for (int value = 0; value < 5; ++value) {
    const auto done = carried_out(fmt::format(
        "#1={}\no1 if [#1 eq 1]\nX1\no1 else if [#1 eq 2]\nX2\no1 elseif [#1 le 3]\nX3\no1 else\nX4\no1 endif", value));
    const int expected = value == 1 ? 1 : value == 2 ? 2 : value <= 3 ? 3 : 4;
    EXPECT_THAT(done, ElementsAre(fmt::format("X{}", expected))) << value;
  }
  EXPECT_THAT(carried_out("o1 if [0]\nX1\no1 endif\nY1"), ElementsAre("Y1"));
  EXPECT_THAT(carried_out("o1 if [0.0001]\nX1\no1 endif"), ElementsAre("X1")) << "whatever is not 0";
  EXPECT_THAT(carried_out("o1 if [1]\nX1\no1 elseif [1/0]\nX2\no1 endif"), ElementsAre("X1")) << "no test behind it";
}

TEST(Rs274Condition, IsNotEvaluatedWhereNothingComesToIt) {
  EXPECT_THAT(carried_out("o1 if [0]\no2 while [#99]\no2 endwhile\no#98 call\no1 endif\nX1"), ElementsAre("X1"));
}

TEST(Rs274Label, IsANumberANameOrComputed) {
  EXPECT_THAT(carried_out("O007 repeat [2]\nX1\no 7 end repeat"), ElementsAre("X1", "X1"));
  EXPECT_THAT(carried_out("o<My Loop> repeat [2]\nX1\no<myloop> endrepeat"), ElementsAre("X1", "X1"));
  EXPECT_THAT(carried_out("o[2*3+1] repeat [2]\nX1\no7 endrepeat"), ElementsAre("X1", "X1"));
  EXPECT_THAT(carried_out("#1=4\no#1 repeat [2]\nX1\no#1 endrepeat"), ElementsAre("X1", "X1"));
  EXPECT_THAT(carried_out("N10 o1 repeat [2] (twice) ; so\nN20 X1\nN30 o1 endrepeat (end)"), ElementsAre("X1", "X1"));
}

TEST(Rs274Label, MayBeUsedAgainBehindItsBlock) {
  EXPECT_THAT(carried_out("o1 repeat [2]\nX1\no1 endrepeat\no1 if [1]\nX2\no1 endif"), ElementsAre("X1", "X1", "X2"));
}

TEST(Rs274Statement, IsLeftOutWithItsSlash) {
  const std::string program = "/o1 repeat [2]\nX1\n/o1 endrepeat";
  EXPECT_THAT(carried_out(program), ElementsAre("X1", "X1"));
  EXPECT_THAT(carried_out(program, {}, true), ElementsAre("X1"));
}

TEST(Rs274Block, IsRefusedWhereItIsNotClosedOrDoesNotMatch) {
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"X1\n o1 while [1]\nX2", "2:2: o1 while is not closed; write o1 endwhile"},
      {"o1 do\nX2", "1:1: o1 do is not closed; write o1 while"},
      {"o1 if [1]\no2 repeat [1]\no1 endif",
       "3:1: o1 endif does not belong to the innermost block that is open, o2 repeat of line 2"},
      {"o1 while [1]\no2 endwhile", "2:1: o2 endwhile does not belong"},
      {"o1 while [1]\no1 endrepeat", "2:1: o1 endrepeat does not belong"},
      {"o1 endif", "1:1: o1 endif, and no if is open"},
      {"o1 if [1]\no1 else\no1 else\no1 endif", "3:1: o1 else behind its else of line 2"},
      {"o1 if [1]\no1 else\no1 elseif [1]\no1 endif", "3:1: o1 elseif behind its else"},
      {"o1 if [1]\no1 if [1]\no1 endif\no1 endif", "2:1: o1 of line 1 is not closed yet"},
      {"o1 repeat [2]\no1 break\no1 endrepeat", "2:1: break of o1 repeat: it is for while and do"},
      {"o1 while [1]\no2 continue\no1 endwhile", "2:1: o2 continue stands in no while or do of this label"},
      {"o1 break", "1:1: o1 break stands in no while or do"},
      {"o1 if 1\no1 endif", "1:7: if is followed by a value in brackets"},
      {"o1 while [1] X2\no1 endwhile", "1:14: nothing but a comment"},
      {"o1 if [1] (probeopen x.txt)\no1 endif", "1:11: (PROBEOPEN"},
      {"o1 else X2", "1:9: nothing but a comment"},
      {"o1 until [1]", "1:4: o1 is followed by sub, call"},
      {"o X1", "1:3: O is followed by a number"},
      {"o<> if [1]", "1:2: a name stands in < >"},
      {"o[1 if [1]", "1:2: this bracket is not closed"},
      {"o[0.5] if [1]\no[0.5] endif", "1:2: 0.5 is no number of an O word"},
      {"X1 o1 if [1]\no1 endif", "1:4: an O word begins its line"},
  };
  for (const auto& [program, message] : wrong) {
    const auto done = carried_out(program);
    ASSERT_THAT(done, testing::Not(IsEmpty())) << program;
    EXPECT_THAT(done.back(), StartsWith(message)) << program;
  }
}

TEST(Rs274Block, IsRefusedOnlyWhereTheProgramComesToIt) {
  EXPECT_THAT(carried_out("X1\nM2\no1 what is this\no2 endif"), ElementsAre("X1"));
  EXPECT_THAT(carried_out("X1\no1 if [1]\no2 endif").front(), StartsWith("X1"));
  EXPECT_THAT(carried_out("o1 if [0]\nX1\no2 what\no1 endif").back(), StartsWith("3:4: o2 is followed by"))
      << "a block is entered, or passed, only where all of it is understood";
}

TEST(Rs274Block, IsRefusedBeyondAHundredLevels) {
  std::string program, ends;
  for (int level = 1; level <= 101; ++level) {
    program += fmt::format("o{} if [1]\n", level);
    ends.insert(0, fmt::format("o{} endif\n", level));
  }
  EXPECT_THAT(carried_out(program + ends).back(), StartsWith("101:1: blocks nested more than 100 deep"));
}

TEST(Rs274Loop, IsEndedWhereItGoesOnForEver) {
  EXPECT_THAT(carried_out("o1 while [1]\no1 endwhile"),
              ElementsAre(StartsWith("2:1: 1000 lines were carried out without a move")));
  EXPECT_THAT(carried_out("#1=0\no1 do\n#1=[#1+1]\no1 while [#1 gt 0]").back(), StartsWith("4:1: 1000 lines"));
  EXPECT_THAT(carried_out("o1 repeat [1e9]\no1 endrepeat").back(), StartsWith("1:13: an operator or ] expected"));
  EXPECT_THAT(carried_out("o1 repeat [1000000000]\no1 endrepeat").back(), StartsWith("2:1: 1000 lines"));
  EXPECT_THAT(carried_out("o1 while [1]\no1 continue\no1 endwhile").back(), StartsWith("2:1: 1000 lines"));
  EXPECT_THAT(carried_out("o1 repeat [900]\nX1\no1 endrepeat"), SizeIs(900)) << "moves are what it is for";
}

TEST(Rs274Loop, MayTakeManyLinesWhereNoneComesAgain) {
  std::string program;
  for (int line = 0; line < 5000; ++line) program += "#1=1\n";
  EXPECT_THAT(carried_out(program + "X1"), ElementsAre("X1"));
}

/// Random programs of nested blocks against what the blocks mean, done here by recursion.
class Nested {
 public:
  explicit Nested(unsigned seed) : random_(seed) {}

  void block(int depth) {
    for (int part = 0; part < 3; ++part) {
      const auto kind = random_() % (depth > 3 ? 1 : 4);
      const int label = ++labels_, times = static_cast<int>(random_() % 4);
      if (kind == 0) {
        text += fmt::format("X{}\n", label);
        expected.push_back(fmt::format("X{}", label));
        continue;
      }
      if (kind == 1) text += fmt::format("o{} repeat [{}]\n", label, times);
      if (kind == 2) text += fmt::format("#<c{0}>=0\no{0} while [#<c{0}> lt {1}]\n#<c{0}>=[#<c{0}>+1]\n", label, times);
      if (kind == 3) text += fmt::format("o{} if [{} gt 1]\n", label, times);
      const auto before = expected;
      expected.clear();
      block(depth + 1);
      const auto body = std::exchange(expected, before);
      for (int round = 0; round < (kind == 3 ? times > 1 : times); ++round) {
        expected.insert(expected.end(), body.begin(), body.end());
      }
      text += fmt::format("o{} {}\n", label, kind == 1 ? "endrepeat" : kind == 2 ? "endwhile" : "endif");
    }
  }

  std::string text;
  std::vector<std::string> expected;

 private:
  std::mt19937 random_;
  int labels_ = 0;
};

TEST(Rs274Loop, NestsAsItIsWritten) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Nested program(seed);
    program.block(0);
    EXPECT_EQ(carried_out(program.text, {}), program.expected) << program.text;
  }
}

}  // namespace
}  // namespace rmac::rs274
