#include "unit/clients/legacy/bounds.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

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

/// `a * b + c` and its like of all operators: of two that bind alike the left one comes first; comparisons bind least.
TEST(FanucValue, BindsEveryTwoOperatorsAsTheManualHasThem) {
  struct Binding {
    std::string_view word;
    int level;
    double (*apply)(double, double);
  };
  const std::vector<Binding> operators{
      {"*", 3, [](double a, double b) { return a * b; }},
      {"/", 3, [](double a, double b) { return a / b; }},
      {"MOD", 3, [](double a, double b) { return std::fmod(a, b); }},
      {"AND", 3, [](double a, double b) { return static_cast<double>(static_cast<int>(a) & static_cast<int>(b)); }},
      {"+", 2, [](double a, double b) { return a + b; }},
      {"-", 2, [](double a, double b) { return a - b; }},
      {"OR", 2, [](double a, double b) { return static_cast<double>(static_cast<int>(a) | static_cast<int>(b)); }},
      {"XOR", 2, [](double a, double b) { return static_cast<double>(static_cast<int>(a) ^ static_cast<int>(b)); }}};
  const std::vector<std::array<double, 3>> numbers{{12, 6, 3}, {8, 2, 1}, {30, 15, 5}, {24, 12, 4}};
  for (const auto& first : operators) {
    for (const auto& second : operators) {
      for (const auto& [a, b, c] : numbers) {
        const double inner = second.level > first.level ? second.apply(b, c) : first.apply(a, b);
        if (inner < 0 || inner != std::round(inner)) continue;  // AND and its like take none
        const double wanted = second.level > first.level ? first.apply(a, inner) : second.apply(inner, c);
        if (!std::isfinite(wanted)) continue;
        const auto text = fmt::format("{} {} {} {} {}", a, first.word, b, second.word, c);
        EXPECT_NEAR(value_of("#1", "#1=" + text + "\n"), std::round(wanted * 1000) / 1000, 1e-9) << text;
        for (const auto& [compares, is] : std::map<std::string, bool>{
                 {"EQ", true}, {"NE", false}, {"GE", true}, {"LE", true}, {"GT", false}, {"LT", false}}) {
          if (wanted != std::round(wanted) || wanted < 0) continue;
          const auto condition = fmt::format("IF [{} {} {} + 0] THEN #5=1.\nG0 X#5", text, compares, wanted);
          EXPECT_EQ(!xs_of(condition).empty(), is) << condition;
        }
      }
    }
  }
}

/// What is half a statement says what is missing, and where.
TEST(FanucStatement, SaysWhatIsMissing) {
  for (const auto& [lines, why] : std::vector<std::pair<std::string, std::string>>{
           {"#1", "5:3: = expected"},
           {"#1 5", "5:5: = expected"},
           {"#1+2=5", "5:3: = expected"},
           {"IF [1 EQ 2] THEN #1", "= expected"},
           {"IF [1 EQ 2] THEN #1 5", "= expected"},
           {"IF", "5:3: a condition stands in [ ]"},
           {"IF #1 EQ 1 GOTO 5", "5:4: a condition stands in [ ]"},
           {"WHILE #1 EQ 1 DO1\nEND1", "WHILE has its condition in [ ]"},
           {"IF [5] GOTO 5", "5:4: a condition compares, as in [#1 EQ 2]; this is a value"},
           {"IF [1 EQ 1]", "GOTO or THEN stands behind the condition of IF"},
           {"IF [1 EQ 2] G0 X1.", "GOTO or THEN stands behind the condition of IF"},
           {"IF [1 EQ 1] THEN", "behind THEN a variable is set"},
           {"IF [1 EQ 2] THEN G0 X1.", "behind THEN a variable is set"},
           {"IF [1 EQ 2] GOTO 5 X1.", "nothing but a comment"},
           {"GOTO 5 X1.\nN5", "nothing but a comment"},
           {"DPRNT", "what is printed stands in [ ]"},
           {"DPRNT X1", "what is printed stands in [ ]"},
           {"DPRNT[X#1[44]", "what is printed stands in [ ]"},
           {"DPRNT[X1] X1.", "nothing but a comment"},
           {"POPEN 5", "nothing but a comment"},
           {"SETVN 101[A]", "names of variables are not taken"},
           {"N1234567890 G0 X1.", "N has a number of 1 to 9 digits"},
           {"N G0 X1.", "N has a number of 1 to 9 digits"},
           {"G65 A1.", "G65 and G66 need P"},
           {"G65 P7 A1. A2.", "two A words in one call"},
           {"G65 P7 G0", "another G code beside G65 or G66"},
           {"G65 P8",
            "O8 is not in this file, and no other is read; write O8 ... M99 behind the end of the main "
            "program, before the second %"},
           {"G65 P9700", "Makers of probes have theirs from O9700 on"},
           {"G65 P9999", "Makers of probes have theirs from O9700 on"},
           {"G65 P9023", "Makers of probes have theirs from O9700 on"},
           {"G65 P9699", "O9699 is not in this file, and no other is read"},
           {"G66 P7\nG66 P7", "G66 within G66 is not taken"},
           {"M98 P7 M99", "one of M97, M98 and M99 in a block"},
           {"G52", "G52 needs X, Y or Z"},
           {"G91 G52 X1.", "G52 under G91"},
           {"G92", "G92 needs X, Y or Z"},
           {"G54.1", "G54.1 needs P"},
           {"G54.1 G4 P1.", "G54.1 needs P"},
           {"G54.1 P1 G73 X1. R0 Z-1. Q1.", "a block without another P"},
           {"G10 P1 X0", "of G10 there are L2 and L20"},
           {"G10 L2 X0", "G10 needs P, the work system"},
       })
    EXPECT_THAT(refused(lines), HasSubstr(why)) << lines;
  for (const std::string taken :
       {"DPRNT[X#1[44]]", "DPRNT[]", "BPRNT[A]", "POPEN", "PCLOS", "IF [1 EQ 2] GOTO 5", "IF [1 EQ 2] THEN #1=1",
        "N123456789 G0 X1.", "/5 G0 X1.", "/N7 G0 X1.", "G66 P7\nG67\nG66 P7\nG67"})
    EXPECT_EQ(refused(taken), "taken") << taken;
}

/// A modal call ends where the program that began it returns, and by G67.
TEST(FanucCall, OfG66EndsWithTheProgramThatBeganIt) {
  const std::string called = "O7\nG0 Z5.\nG0 Z10.\nM99\n", begins = "O8\nG66 P7\nG0 X2.\nM99\n";
  const auto count = [&](const std::string& lines) { return ends_of(lines, {}, called + begins).size(); };
  EXPECT_EQ(count("G66 P7\nG0 X1.\nG0 X2.\nG67\nG0 X3."), 2U * 3 + 1);
  EXPECT_EQ(count("M98 P8\nG0 X3."), 3U + 1) << "it was O8's";
}

/// A cycle's levels were meant in the coordinates where it began: whatever shifts those along any axis ends it.
TEST(FanucCycle, EndsWhereItsCoordinatesAreShifted) {
  for (const std::string shift : {"G52 X5.", "G52 Y5.", "G52 Z5.", "G92 X5.", "G92 Y5.", "G92 Z5.", "G55"}) {
    Options options = bounded();
    options.offsets[1] = {1, 2, 3};
    EXPECT_THAT(refusal_of(program_of("G81 X1. R0 Z-1.\n" + shift + "\nX2."), options),
                HasSubstr("in the midst of a cycle"))
        << shift;
  }
  EXPECT_EQ(refused("G81 X1. R0 Z-1.\nG52 X0\nX2."), "taken") << "nothing is shifted";
}

TEST(FanucBounds, OfOffsetsThatAreNotKnown) {
  for (const std::string lines : {"G91 G10 L2 P2 X1.", "G91 G10 L2 P2 Y1.", "G91 G10 L20 P3 Z1."})
    EXPECT_THAT(refusal_of(program_of(lines)), HasSubstr("what this is added to (G91) is not known here")) << lines;
  EXPECT_EQ(refusal_of(program_of("G10 L2 P2 X1. Y0 Z0\nG91 G10 L2 P2 X1.")), "taken");
  expect_bounds({{"D{}", "D is the number of an offset", {"0", "1", "999999"}, {"-1", "1.5", "1000000"}}}, refused);
}

/// Directions are no lengths: what is computed of one is not rounded to an increment, of any of its words.
TEST(FanucValue, OfADirectionIsNotRounded) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string words = axis == 0 ? "I[1/3] J0 K1." : axis == 1 ? "I0 J[1/3] K1." : "I1. J0 K[1/3]";
    const auto moves = legacy::moves_in(imported(program_of("G43.5\nG1 X1. " + words)));
    ASSERT_FALSE(moves.empty());
    const auto axes = legacy::end_of(moves.back()).at("axis").get<std::vector<double>>();
    EXPECT_NEAR(axes.at(axis) / axes.at(axis == 2 ? 0 : 2), 1.0 / 3, 1e-8) << words;
  }
}

TEST(HaasHoles, AreDrilledByEachOfTheCycles) {
  for (const std::string cycle :
       {"G73 R0 Z-1. Q1.", "G81 R0 Z-1.", "G82 R0 Z-1. P1", "G83 R0 Z-1. Q1.", "G85 R0 Z-1.", "G89 R0 Z-1. P1"}) {
    EXPECT_EQ(refused_of_haas(cycle + " L0\nG70 I5. L3"), "taken") << cycle;
    EXPECT_THAT(refused_of_haas(cycle + "\nG12 I9. Z-1. D1 F100."),
                HasSubstr("a pocket while a canned cycle is in force"))
        << cycle;
  }
  for (const std::string none : {"G80", "G0 X1.", "G1 X1.", "G2 X1. I0.5"})
    EXPECT_THAT(refused_of_haas(none + "\nG70 I5. L3"), HasSubstr("no cycle how they are drilled")) << none;
}

/// Arcs of angles are within a turn, from zero on.
TEST(FanucValue, HasAnglesOfEveryQuarter) {
  for (double degrees = 0; degrees < 360; degrees += 0.5) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto near = [&](const std::string& value, double wanted) {
      EXPECT_NEAR(value_of("#1", "#1=" + value + "\n"), wanted, 1.1e-3) << value;
    };
    near(fmt::format("ATAN[{:.9f}]/[{:.9f}]", std::sin(angle), std::cos(angle)), degrees);
    if (degrees <= 90 || degrees >= 270) near(fmt::format("ASIN[{:.9f}]", std::sin(angle)), degrees);
    if (degrees <= 180) near(fmt::format("ACOS[{:.9f}]", std::cos(angle)), degrees);
  }
}

TEST(FanucStatement, OfLookAheadAndDwellsSaysWhatIsMissing) {
  for (const auto& [lines, why] : std::vector<std::pair<std::string, std::string>>{
           {"G5", "G5 needs P, as in G5 P10000"},
           {"G5.1", "G5.1 needs Q, as in G5.1 Q1"},
           {"G8", "G8 needs P, as in G8 P1"},
           {"G4 X1. P1", "a dwell has one time; take this or P out"},
           {"#0=1.", "#0 is always vacant; nothing sets it"},
           {"M98 P50007", "P50007"},
       })
    EXPECT_THAT(refusal_of(program_of(lines, "O7\nM99\nO50007\nM99\n"), bounded()), HasSubstr(why)) << lines;
  const auto times = [](const std::string& call) {
    return xs_of("#100=0\n" + call + "\nG0 X#100", "O7\n#100=#100+1\nM99\n").back();
  };
  EXPECT_EQ(times("M98 P7"), 1);
  EXPECT_EQ(times("M98 P50007"), 5) << "older controls have the times before the four digits of the number";
  EXPECT_EQ(times("M98 P120007"), 12);
  EXPECT_EQ(times("M98 P7 L3"), 3);
  EXPECT_EQ(times("G65 P7 L4"), 4);
}

}  // namespace
}  // namespace rmac::fanuc
