#include <gmock/gmock.h>

#include <random>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Rs274Block, HasSpacesAnywhereAndSmallLetters) {
  EXPECT_THAT(ends_of("n 1 0 g 0 x 1 2 . 5\ty - 3"), ElementsAre(ElementsAre(12.5, -3, 10)));
}

TEST(Rs274Block, TakesCommentsBetweenItsWords) {
  EXPECT_THAT(ends_of("(first) G0 (way) X1 ; all of the rest: G0 X2"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G0 X1 (open")), StartsWith("3:7: this comment does not end"));
  EXPECT_THAT(refusal_of(program_of("G0 X(in the word)1")), StartsWith("3:5: a number expected"));
}

TEST(Rs274Block, HasACarriageReturnAtItsEndOnly) {
  EXPECT_THAT(ends_of("G0 X1\r\nX2 (said)\r\nX3 ; said\r"),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(2, 0, 10), ElementsAre(3, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("G0 X1\rG0 X2")), StartsWith("3:6: a carriage return within a line"));
  EXPECT_THAT(refusal_of(program_of("G0 X1 (a\rb)")), StartsWith("3:9: a carriage return within a line"));
}

TEST(Rs274Block, HasNoByteThatReadsLikeAComment) {
  EXPECT_THAT(refusal_of(program_of("G0 X1\x01")), StartsWith("3:6: a control character"));
}

TEST(Rs274Block, IsLeftOutOnlyWhereItsSlashIsSwitched) {
  EXPECT_EQ(ends_of("/G0 X1").size(), 1U);
  EXPECT_EQ(ends_of("/G0 X1", {.block_delete = true}).size(), 0U);
}

TEST(Rs274Block, HasOneCodeOfAModalGroup) {
  EXPECT_THAT(refusal_of(program_of("G0 X1 G1 Y1")), StartsWith("3:7: G0 and G1 are of one modal group"));
  EXPECT_THAT(refusal_of(program_of("M3 M5")), StartsWith("3:4: M3 and M5 are of one modal group"));
  EXPECT_THAT(refusal_of(program_of("G0 X1 X2")), StartsWith("3:7: two X words"));
  EXPECT_THAT(refusal_of(program_of("G1 X1 G92 Y1")), HasSubstr("both use the axis words"));
}

TEST(Rs274Block, IsRefusedForAWordThatNothingUses) {
  EXPECT_THAT(refusal_of(program_of("G1 X3 P2")), StartsWith("3:7: nothing in this block uses P"));
  EXPECT_THAT(refusal_of(program_of("G80 X3")), StartsWith("3:5: nothing in this block uses X"));
  EXPECT_THAT(refusal_of(program_of("D7")), StartsWith("3:1: nothing in this block uses D"));
}

TEST(Rs274Block, IsRefusedForWhatIsNotTaken) {
  for (const char* code :
       {"G33",   "G28",   "G41", "G76",  "G73", "G38.2", "G95", "G96",  "G87",  "G43.1",
        "G61.1", "G18.1", "G9",  "G200", "M19", "M49",   "M62", "M100", "G1.5", "(PROBEOPEN x.txt)"}) {
    EXPECT_THAT(refusal_of(program_of(code)), StartsWith("3:1: ")) << code;
  }
  EXPECT_THAT(refusal_of(program_of("G0 A90")), HasSubstr("give --rotary"));
}

TEST(Rs274Program, EndsWithM2OrM30OrPercent) {
  EXPECT_EQ(imported("G21 G0 X0 Y0 Z0\nM30\nnothing that could be read\n").requests.size(), 1U);
  EXPECT_EQ(imported("%\nG21 G0 X0 Y0 Z0\n%\n").requests.size(), 1U);
  EXPECT_THAT(refusal_of("G21 G0 X0 Y0 Z0\n"), HasSubstr("may be cut off"));
  EXPECT_THAT(refusal_of("%\nG21 G0 X0 Y0 Z0\n"), HasSubstr("second %"));
  EXPECT_THAT(refusal_of(""), HasSubstr("may be cut off"));
}

TEST(Rs274Program, IsRefusedWithoutItsUnit) {
  EXPECT_THAT(refusal_of("G0 X1 Y1 Z1\nM2\n"), StartsWith("1:4: no G20 or G21"));
  EXPECT_EQ(imported("G0 X1 Y1 Z1\nM2\n", {.unit_mm = 25.4}).requests[0]["params"]["TargetFrame"]["p"][0], 25.4);
}

/// Whatever bytes come, they are taken or refused with a place within them.
TEST(Rs274Program, NeverCrashesWhateverItIs) {
  std::mt19937 random(20261124);
  const std::string letters = "GGGMXYZIJKRPQFSTNO#<>[]()%;/=+-*.0123456789 \n\n\tABCDEHLUVWsincosatanmodeq\x01\x80\xff";
  const std::vector<std::string> pieces{"G1",
                                        "G2",
                                        "G83",
                                        "X[",
                                        "]",
                                        "#1=",
                                        "#<a>=",
                                        "ATAN[1]/[2]",
                                        "R2 Z-3 ",
                                        "\n",
                                        "G91",
                                        "G20",
                                        "G10 L2 P1",
                                        "M6 T1",
                                        "EXISTS[#",
                                        "\no1 while[1]",
                                        "\no1 endwhile\n",
                                        "\no2 sub\n",
                                        "\no2 endsub[1]\n",
                                        "\no2 call[",
                                        "\nM98 P3\n",
                                        "\nO3\n",
                                        "\nM99\n",
                                        "\no4 repeat[3]\n",
                                        "\no4 endrepeat\n",
                                        "\no1 break\n"};
  for (int program = 0; program < 3000; ++program) {
    std::string text = "G21 F9 G0 X0 Y0 Z0\n";
    for (int piece = 0; piece < 60; ++piece) {
      text += random() % 3 == 0 ? pieces[random() % pieces.size()] : std::string(1, letters[random() % letters.size()]);
    }
    const auto summary =
        import_program(text, {.bounds = {.idle_lines = 1000, .output_mb = 1}}, [](std::string_view) {});
    if (summary) continue;
    EXPECT_GE(summary.error().line, 1U) << text;
    EXPECT_GE(summary.error().column, 1U) << text;
    EXPECT_FALSE(summary.error().message.empty()) << text;
  }
}

}  // namespace
}  // namespace rmac::rs274
