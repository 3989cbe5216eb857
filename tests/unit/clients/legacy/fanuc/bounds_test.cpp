#include "unit/clients/legacy/bounds.hpp"

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using legacy::expect_bounds;
using testing::HasSubstr;

constexpr std::string_view kCalled = "O7\nM99\nO99999999\nM99\n";

Options bounded() {
  Options options;
  for (std::size_t system = 0; system < 306; ++system) options.offsets[system] = {0, 0, 0};
  options.whole_numbers = gcode::WholeNumbers::Units;
  options.passed_m = {99'999'999};
  options.tool_diameters_mm = {{1, 4}};
  return options;
}

std::string refused(const std::string& lines) {
  return refusal_of(program_of(lines, kCalled), bounded());
}
std::string refused_of_haas(const std::string& lines) {
  return refusal_of(program_of(lines, kCalled), bounded(), Dialect::Haas);
}

TEST(FanucBounds, OfCalls) {
  expect_bounds(
      {
          {"M98 P{}", "P of M98 is the number of a program", {"7", "99999999"}, {"0", "-7", "1.5", "100000000"}},
          {"M98 P7 L{}", "L of M98 says how often", {"1", "9999"}, {"0", "-1", "1.5", "10000"}},
          {"G65 P{}", "P is the number of the macro", {"7", "99999999"}, {"0", "-7", "1.5", "100000000"}},
          {"G65 P7 L{}", "L says how often the macro is called", {"1", "9999"}, {"0", "-1", "1.5", "10000"}},
          {"M{}", "M is a whole number", {"99999999", "8"}, {"-1", "1.5", "100000000"}},
          {"G{} X1.", "there is no G", {"1", "01", "0"}, {"0.5", "1.1", "-1", "999", "99999", "100000", "100001"}},
          {"GOTO{}\nN1\nN999999999",
           "GOTO goes to the N of a line",
           {"1", "999999999"},
           {"0", "-1", "1.5", "1000000000"}},
          {"WHILE[0 EQ 1]DO{0}\nEND{0}", "a loop has the number 1, 2 or 3", {"1", "2", "3"}, {"0", "4", "9"}},
      },
      refused);
}

TEST(FanucBounds, OfLocalCallsOfAHaas) {
  expect_bounds(
      {
          {"M97 P{}\nM30\nN9\nM99\nN99999999\nM99",
           "P of M97 is the N of a line",
           {"9", "99999999"},
           {"0", "-1", "1.5", "100000000"}},
          {"M97 P9 L{}\nM30\nN9\nM99", "L of M97 says how often", {"1", "9999"}, {"0", "-1", "1.5", "10000"}},
          {"G154 P{}", "P of this is a work system", {"1", "99"}, {"0", "-1", "1.5", "100"}},
      },
      refused_of_haas);
}

TEST(FanucBounds, OfWorkSystems) {
  expect_bounds(
      {
          {"G54.1 P{}", "P of this is a work system", {"1", "300"}, {"0", "-1", "1.5", "301"}},
          {"G10 L2 P{} X0 Y0 Z0", "P of G10 is the work system", {"1", "6"}, {"-1", "7", "1.5"}},
          {"G10 L2 P{} X0", "the offset of all work systems", {}, {"0"}},
          {"G10 L20 P{} X0 Y0 Z0", "P of G10 is the work system", {"1", "300"}, {"0", "-1", "1.5", "301"}},
          {"G10 L{} P1 X0 Y0 Z0", "of G10 there are L2 and L20", {"2", "20"}, {"0", "1", "3", "10", "19", "21"}},
          {"G92.1 X{}", "X, Y and Z of G92.1 are 0", {"0"}, {"1", "-1", "0.5"}},
      },
      refused);
}

TEST(FanucBounds, OfVariables) {
  expect_bounds(
      {
          {"#{}=1.\nG0 X1.", "there is no #", {"1", "33", "100", "199", "500", "999"}, {"34", "99", "200", "499"}},
          {"G0 X#{}", "there is no #", {"1", "33"}, {"34", "99", "200", "499"}},
          {"G0 X#{}", "was not set before", {}, {"100", "199", "500", "999"}},
          {"#1={} AND 1", "whole numbers", {"0", "4294967295"}, {"0.5", "4294967296"}},
          {"#1=ASIN[{}]", "beyond -1 to 1", {"1", "-1", "0"}, {"1.001", "-1.001"}},
          {"#1=ACOS[{}]", "beyond -1 to 1", {"1", "-1", "0"}, {"1.001", "-1.001"}},
          {"#1=SQRT[{}]", "the square root of a negative number", {"0", "4"}, {"-0.001"}},
          {"#1=LN[{}]", "the logarithm of a number that is not positive", {"0.001", "1"}, {"0", "-1"}},
          {"#1=BIN[{}]", "digits of four bits are 0 to 9", {"0", "9", "16", "153"}, {"10", "15", "26", "160"}},
          {"#1=BCD[{}]", "take no negative numbers", {"0", "9", "99"}, {"-1"}},
          {"#1=POW[-2.,{}]", "a negative number has no such power", {"2", "-3", "0"}, {"0.5"}},
          {"#1=POW[0,{}]", "zero has no negative power", {"0", "1"}, {"-1"}},
      },
      refused);
}

TEST(FanucBounds, OfArgumentsOfACall) {
  std::string sets;
  for (int set = 0; set < 10; ++set) sets += "I1.J2.K3.";
  EXPECT_EQ(refused("G65 P7 " + sets), "taken");
  EXPECT_THAT(refused("G65 P7 " + sets + "I1."), HasSubstr("more than ten sets of I, J and K"));
}

/// Each letter of G65 sets the variable that manuals have in their table of arguments.
TEST(FanucCall, GivesEachLetterItsVariable) {
  const std::map<char, int> variables{{'A', 1},  {'B', 2},  {'C', 3},  {'D', 7},  {'E', 8},  {'F', 9},  {'H', 11},
                                      {'I', 4},  {'J', 5},  {'K', 6},  {'M', 13}, {'Q', 17}, {'R', 18}, {'S', 19},
                                      {'T', 20}, {'U', 21}, {'V', 22}, {'W', 23}, {'X', 24}, {'Y', 25}, {'Z', 26}};
  for (const auto& [letter, variable] : variables) {
    for (int number = 1; number <= 33; ++number) {
      const auto xs = xs_of(
          fmt::format("G65 P7 {}5.", letter),
          fmt::format("O7\nIF [#{} EQ #0] THEN #100=1.\nIF [#{} NE #0] THEN #100=2.\nG0 X#100\nM99\n", number, number));
      ASSERT_EQ(xs.size(), 1U);
      EXPECT_EQ(xs.front(), number == variable ? 2 : 1) << letter << " and #" << number;
    }
  }
  for (int set = 0; set < 10; ++set) {
    std::string words;
    for (int before = 0; before < set; ++before) words += "I1.";
    const auto call = fmt::format("G65 P7 {}I2.J3.K4.", words);
    const auto program = fmt::format("O7\nG0 X#{} Y#{} Z#{}\nM99\n", 4 + 3 * set, 5 + 3 * set, 6 + 3 * set);
    const auto ends = ends_of(call, {}, program);
    ASSERT_EQ(ends.size(), 1U);
    EXPECT_THAT(ends.front(), testing::ElementsAre(2, 3, 4));
  }
}

/// What a program asks of the system and is not known here: it is said what that would be.
TEST(FanucVariable, OfTheSystemHasARangeOfNumbersForEachKind) {
  struct Kind {
    int first, last;
    std::string what;
  };
  const std::vector<Kind> kinds{
      {1000, 1199, "signals between a control and its machine"},
      {2000, 2999, "tool offsets"},
      {3000, 3000, "an alarm, which is only set"},
      {3001, 3002, "clocks of a control"},
      {3003, 3004, "the operator's overrides"},
      {3005, 3999, "settings and clocks"},
      {4100, 4108, "codes that were in force"},
      {4121, 4999, "codes that were in force"},
      {5004, 5020, "places of the tool, of which"},
      {5024, 5040, "places of the tool, of which"},
      {5044, 5060, "places of the tool, of which"},
      {5061, 5080, "what the last G31 found"},
      {5081, 5199, "places of the tool, of which"},
      {5200, 5999, "work offsets; set them by G10 L2"},
      {7000, 7999, "work offsets; set them by G10 L20"},
      {10000, 19999, "tool offsets"},
      {1200, 1999, "is a variable of the system, and not known here"},
      {6000, 6999, "is a variable of the system, and not known here"},
      {8000, 9999, "is a variable of the system, and not known here"},
      {20000, 99999, "is a variable of the system, and not known here"},
  };
  for (const auto& kind : kinds) {
    for (const int number : {kind.first, (kind.first + kind.last) / 2, kind.last}) {
      const auto why = refused(fmt::format("#1=#{}", number));
      EXPECT_THAT(why, HasSubstr(fmt::format("#{} is ", number))) << number;
      EXPECT_THAT(why, HasSubstr(kind.what)) << number;
    }
  }
  EXPECT_THAT(refused("#1=#100000"), HasSubstr("#"));
}

/// #4001 to #4120: the codes in force, each by a number of its group.
TEST(FanucVariable, OfTheSystemFollowsEachCode) {
  const auto read = [](const std::string& lines, int number, const Options& options = bounded()) {
    const auto ends = ends_of(lines + fmt::format("\n#1=#{}\nG49 G90 G94 G21 G80\nG0 X#1 Y1.", number), options);
    return ends.empty() ? NAN : ends.back().at(0);
  };
  for (const int code : {0, 1, 2, 3}) {
    const std::string way = code < 2 ? "X1." : "X1. I0.5";
    EXPECT_EQ(read(fmt::format("G{} {}", code, way), 4001), code);
    EXPECT_EQ(read(fmt::format("G{} {}", code, way), 4009), 80);
  }
  for (const int code : {17, 18, 19}) EXPECT_EQ(read(fmt::format("G{}", code), 4002), code);
  for (const int code : {90, 91}) EXPECT_EQ(read(fmt::format("G{}", code), 4003), code);
  for (const int code : {93, 94}) EXPECT_EQ(read(fmt::format("G{}", code), 4005), code);
  for (const int code : {20, 21}) EXPECT_EQ(read(fmt::format("G{}", code), 4006), code);
  for (const int code : {81, 82, 85}) EXPECT_EQ(read(fmt::format("G{} X1. R0 Z-1. P0", code), 4009), code);
  for (const int code : {98, 99}) EXPECT_EQ(read(fmt::format("G{}", code), 4010), code);
  for (const int code : {54, 55, 58, 59}) EXPECT_EQ(read(fmt::format("G{} G0 X0 Y0 Z0", code), 4014), code);
  EXPECT_EQ(read("F55.", 4109), 55);
  EXPECT_EQ(read("N17", 4114), 17);
  EXPECT_EQ(read("", 4115), 1);
  EXPECT_EQ(read("S1234", 4119), 1234);
  EXPECT_EQ(read("T12", 4120), 12);
}

}  // namespace
}  // namespace rmac::fanuc
