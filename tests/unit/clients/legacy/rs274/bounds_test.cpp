#include "unit/clients/legacy/bounds.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using legacy::Bound, legacy::expect_bounds;

Options bounded() {
  Options options;
  options.inputs = {{0, "Door"}};
  options.outputs = {{3, "Clamp"}, {0, "Lamp"}};
  options.tool_diameters_mm = {{1, 4}, {999'999, 4}};
  return options;
}

std::string refused(const std::string& lines) {
  return refusal_of(program_of(lines), bounded());
}

TEST(Rs274Bounds, OfSpeedsToolsFeedsAndTimes) {
  expect_bounds(
      {
          {"S{}", "S is 0 to 1 000 000", {"0", "0.5", "1000000"}, {"-0.001", "-1", "1000000.001"}},
          {"T{}", "T is a tool's number, 0 to 9999", {"0", "1", "9999"}, {"-1", "10000", "1.5"}},
          {"G1 X1 F{}", "the feed is not within", {"0.01", "1000000"}, {"0.009", "1000000.01"}},
          {"G1 X1 F{}", "no feed was set", {}, {"0"}},
          {"G3 X4 I2 F{}", "no feed was set", {"1"}, {"0"}},
          {"G1 X1 F{}", "a negative feed", {}, {"-0.001", "-600"}},
          {"G93 G1 X100 F{}", "more than 0", {"0.001", "5"}, {"0", "-0.001", "-1"}},
          {"G4 P{}", "a dwell is 0 to 3600 seconds", {"0", "0.001", "3600"}, {"-0.001", "3600.001"}},
          {"G64 P{}", "a path tolerance is 0 to 100 mm", {"0.001", "100"}, {"-0.001", "100.001"}},
          {"G64 P{}", "G64 without P leaves open", {"1"}, {"0"}},
      },
      refused);
}

TEST(Rs274Bounds, OfPlaces) {
  expect_bounds(
      {
          {"G0 X{}", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"G1 Y{}", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"G1 Z{}", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"G2 X4 I2 Z{}", "a move beyond 1 000 000 mm", {"1000000", "-1000000"}, {"1000000.001", "-1000000.001"}},
          {"G2 I5 P{}", "P of an arc is its turns, 1 to 1001", {"1", "2", "1001"}, {"0", "-1", "1.5", "1002"}},
      },
      refused);
}

TEST(Rs274Bounds, OfHoles) {
  expect_bounds(
      {
          {"G81 X1 R0 Z-1 L{}",
           "is how often the hole is repeated, 1 to 10000",
           {"1", "10000"},
           {"0", "-1", "1.5", "10001"}},
          {"G82 X1 R0 Z-1 P{}", "a dwell of less than no time", {"0", "1"}, {"-0.001"}},
          {"G89 X1 R0 Z-1 P{}", "a dwell of less than no time", {"0", "1"}, {"-0.001"}},
          {"G83 X1 R0 Z-1 Q{}", "Q, the depth of a peck, is more than 0", {"0.001"}, {"0", "-0.001"}},
          {"G73 X1 R0 Z-1 Q{}", "Q, the depth of a peck, is more than 0", {"0.001"}, {"0", "-0.001"}},
          {"G83 X1 R0 Z-8 Q{}", "more than 10000 pecks", {"0.0008"}, {"0.00079"}},
          {"G73 X1 R0 Z-8 Q0.008 L{}", "more than 10000 pecks", {"10"}, {"11"}},
          {"G81 X1 R5 Z{}", "the hole's bottom is above R", {"5", "4.999"}, {"5.001", "6"}},
      },
      refused);
}

TEST(Rs274Bounds, OfInputsAndOutputs) {
  expect_bounds(
      {
          {"M66 P0 L3 Q{}", "to 3600 seconds", {"0.001", "3600"}, {"0", "-1", "3600.001"}},
          {"M66 P0 L{} Q1", "M66 is taken with L3 and L4", {"3", "4"}, {"0", "1", "2", "3.5", "5", "-3"}},
          {"M66 P{} L3 Q1", "has a name here", {"0"}, {"1", "-1", "0.5", "1000000", "10000000000"}},
          {"M62 P{}", "has a name here", {"3", "0"}, {"1", "4", "2.5", "3.1", "-3", "1000000", "10000000000"}},
      },
      refused);
}

TEST(Rs274Bounds, OfNumbersOfToolsAndSystems) {
  expect_bounds(
      {
          {"G10 L2 P{} X0 Y0 Z0", "P of G10 is the work system", {"0", "1", "9"}, {"-1", "10", "1.5"}},
          {"G10 L{} P1 X0 Y0 Z0", "of G10 there are L2 and L20", {"2"}, {"0", "1", "3", "10", "11", "21", "2.5"}},
          {"T1 M6\nG43 H{}\nG0 X0 Y0 Z10", "the length of another tool", {"1"}, {"0", "2", "-1"}},
          {"G43 H{}", "does not say that tool", {}, {"0", "1"}},
          {"G41 D{} G1 X9", "is the number of a tool", {"1", "999999"}, {"-1", "1.5", "1000000"}},
          {"G41.1 D{} G1 X2000", "a diameter is 0 to 1000 mm", {"0", "1000"}, {"-0.001", "1000.001"}},
          {"G41.1 D4 L{} G1 X9", "the orientation of a turning tool", {"0"}, {"1", "-1", "0.5"}},
          {"M98 P{}", "P of M98 is the number behind the O", {}, {"-1", "1.5", "1000000001"}},
          {"M98 P1 L{}", "L of M98 says how often", {}, {"-1", "1.5", "1000000001"}},
      },
      refused);
}

TEST(Rs274Bounds, OfSplines) {
  expect_bounds(
      {
          {"G5.2 P{}\nX1 Y1 P1\nX2 Y0 P1\nG5.3",
           "the weight of a control point",
           {"0.001", "1", "1000000"},
           {"0", "-1", "1000000.1"}},
          {"G5.2 P1\nX1 Y1 P{}\nX2 Y0 P1\nG5.3",
           "the weight of a control point",
           {"0.001", "1", "1000000"},
           {"0", "-1", "1000000.1"}},
          {"G5.2 P1 L{}\nX1 Y1 P1\nX2 Y0 P1\nX3 Y1 P1\nX4 Y0 P1\nX5 Y1 P1\nX6 Y0 P1\nX7 Y1 P1\nX8 Y0 P1\nX9 Y1 "
           "P1\nG5.3",
           "the order of a NURBS, is 3 to 10",
           {"3", "4", "10"},
           {"2", "11", "3.5", "-3"}},
          {"G5.2 P1 L{}\nX1 Y1 P1\nX2 Y0 P1\nX3 Y1 P1\nG5.3", "needs as many points", {"3", "4"}, {"5", "10"}},
      },
      refused);
}

TEST(Rs274Bounds, OfCodes) {
  expect_bounds(
      {
          {"G{} X1",
           "there is no G",
           {"1", "1.00009", "0.99991", "0"},
           {"1.0002", "0.9998", "-1", "-0.1", "99.9", "100", "1000"}},
          {"M{}",
           "is a code of the machine's own",
           {"8", "8.0009", "7.9991"},
           {"8.002", "7.998", "-8", "20", "999", "1000"}},
          {"N{} G0 X1", "a line's number is not negative", {"0", "1", "99999"}, {"-1", "-0.001"}},
      },
      refused);
}

TEST(Rs274Bounds, OfParameters) {
  expect_bounds(
      {
          {"#{}=1\nG0 X1", "is the control's own", {"1", "30", "31", "5060"}, {"5061", "5070", "5071", "5602"}},
          {"G0 X#{}", "is what the last G38 found", {}, {"5061", "5070"}},
          {"G0 X#{}", "was not set before", {}, {"1", "5060"}},
          {"#{}=1", "there is no", {}, {"0", "5603", "-1", "1.5"}},
      },
      refused);
}

TEST(Rs274Bounds, OfComputedLabels) {
  expect_bounds(
      {
          {"o7 sub\no7 endsub\no0 sub\no0 endsub\no2000000000 sub\no2000000000 endsub\n#1={}\no#1 call",
           "is no number of an O word",
           {"0", "7", "7.00009", "6.99991", "2000000000"},
           {"-1", "-7", "0.5", "7.0002", "6.9998", "2000000001"}},
      },
      refused);
}

TEST(Rs274Bounds, OfNesting) {
  const auto nested = [](std::size_t depth) {
    return "#1=" + std::string(depth, '[') + "1" + std::string(depth, ']') + "\nG0 X#1";
  };
  EXPECT_EQ(refused(nested(99)), "taken");
  EXPECT_THAT(refused(nested(102)), testing::HasSubstr("nested"));
  const auto blocks = [](int depth) {
    std::string begins, ends;
    for (int at = 1; at <= depth; ++at) {
      begins += fmt::format("o{} if[1]\n", at);
      ends = fmt::format("o{} endif\n", at) + ends;
    }
    return begins + "G0 X1\n" + ends;
  };
  EXPECT_EQ(refused(blocks(100)), "taken");
  EXPECT_NE(refused(blocks(101)), "taken");
}

TEST(Rs274Bounds, OfFunctions) {
  expect_bounds(
      {
          {"#1=[0 ** {}]", "zero has no negative power", {"0", "0.5", "1", "2"}, {"-0.5", "-1"}},
          {"#1=[[0-2] ** {}]", "a negative number has no such power", {"0", "1", "2", "-3"}, {"0.5", "-1.5"}},
          {"#1=SQRT[{}]", "the square root of a negative number", {"0", "0.5", "4"}, {"-0.001"}},
          {"#1=LN[{}]", "the logarithm of a number that is not positive", {"0.001", "0.5", "1"}, {"0", "-1"}},
          {"#1=ASIN[{}]", "the arc of a number beyond -1 to 1", {"-1", "0", "1"}, {"-1.001", "1.001", "2"}},
          {"#1=ACOS[{}]", "the arc of a number beyond -1 to 1", {"-1", "0", "1"}, {"-1.001", "1.001", "2"}},
          {"#1=[1/{}]", "a division by zero", {"0.001", "1", "-1"}, {"0"}},
          {"#1=[1 MOD {}]", "MOD by zero", {"0.001", "1", "-1"}, {"0"}},
      },
      refused);
}

struct Binding {
  std::string_view word;
  int level;  ///< what is greater binds more, as LinuxCNC's manual has it
  double (*apply)(double, double);
};

/// `a * b + c` and its like of all operators: of two that bind alike the left one comes first.
TEST(Rs274Expression, BindsEveryTwoOperatorsAsTheManualHasThem) {
  const std::vector<Binding> operators{{"**", 5, [](double a, double b) { return std::pow(a, b); }},
                                       {"*", 4, [](double a, double b) { return a * b; }},
                                       {"/", 4, [](double a, double b) { return a / b; }},
                                       {"MOD", 4, [](double a, double b) { return std::fmod(std::fmod(a, b) + b, b); }},
                                       {"+", 3, [](double a, double b) { return a + b; }},
                                       {"-", 3, [](double a, double b) { return a - b; }},
                                       {"EQ", 2, [](double a, double b) { return std::abs(a - b) < 1e-4 ? 1.0 : 0.0; }},
                                       {"NE", 2, [](double a, double b) { return std::abs(a - b) < 1e-4 ? 0.0 : 1.0; }},
                                       {"GT", 2, [](double a, double b) { return a > b ? 1.0 : 0.0; }},
                                       {"GE", 2, [](double a, double b) { return a >= b ? 1.0 : 0.0; }},
                                       {"LT", 2, [](double a, double b) { return a < b ? 1.0 : 0.0; }},
                                       {"LE", 2, [](double a, double b) { return a <= b ? 1.0 : 0.0; }},
                                       {"AND", 1, [](double a, double b) { return a != 0 && b != 0 ? 1.0 : 0.0; }},
                                       {"OR", 1, [](double a, double b) { return a != 0 || b != 0 ? 1.0 : 0.0; }},
                                       {"XOR", 1, [](double a, double b) { return (a != 0) != (b != 0) ? 1.0 : 0.0; }}};
  const std::vector<std::array<double, 3>> numbers{{5, 2, 3}, {2, 2, 1}, {1, 3, 3}, {7, 3, 2}, {4, 1, 4}};
  for (const auto& first : operators) {
    for (const auto& second : operators) {
      for (const auto& [a, b, c] : numbers) {
        const double wanted =
            second.level > first.level ? first.apply(a, second.apply(b, c)) : second.apply(first.apply(a, b), c);
        if (!(std::abs(wanted) < 1e5)) continue;
        const auto text = fmt::format("[{} {} {} {} {}]", a, first.word, b, second.word, c);
        EXPECT_NEAR(value_of(text), wanted, 1e-6) << text;
      }
    }
  }
}

TEST(Rs274Bounds, OfNumberedPrograms) {
  expect_bounds({{"M98 P{0}\nM2\nO{0}\nG0 X1\nM99", "", {"0", "1", "99999"}, {}},
                 {"M98 P7 L{}\nM2\nO7\nG0 X1\nM99", "", {"0", "1", "5"}, {}}},
                refused);
}

/// What is half a block, or too much of one, says what is missing or what to leave out.
TEST(Rs274Block, SaysWhatIsMissing) {
  for (const auto& [lines, why] : std::vector<std::pair<std::string, std::string>>{
           {"G4", "G4 needs P, its time in seconds"},
           {"G2 X4 R2 I2", "an arc has a radius or a centre, not both"},
           {"G2 X4 R2 J2", "an arc has a radius or a centre, not both"},
           {"G2 X4 R0", "an arc of radius 0"},
           {"G90.1 G2 X4 I2", "under G90.1 an arc has both"},
           {"G90.1 G2 X4 J2", "under G90.1 an arc has both"},
           {"G5.1 X4 J2", "G5.1 needs I and J"},
           {"G5.1 X4 I2", "G5.1 needs I and J"},
           {"G5.1 X4", "G5.1 needs I and J"},
           {"G18 G5.1 X4 I2 J2", "splines lie in the XY plane"},
           {"G19 G5.2 P1", "splines lie in the XY plane"},
           {"G5.1 X4 I2 J2 Z1", "a spline has no Z"},
           {"G5.2 P1\nX1 Y1 Z1 P1", "a spline has no Z"},
           {"G5.2 P1\nX1 Y1", "a control point of a NURBS has X, Y and its weight P"},
           {"G5.2 P1\nX1 P1", "a control point of a NURBS has X, Y and its weight P"},
           {"G5.2 P1\nY1 P1", "a control point of a NURBS has X, Y and its weight P"},
           {"G5.2 P1\nM3", "between G5.2 and G5.3 each block is a control point"},
           {"G5.2 P1\nG1 X1 Y1 P1", "between G5.2 and G5.3 each block is a control point"},
           {"G93 G5.1 X4 I2 J2 F1", "a spline under G93 is not taken"},
           {"G93 G81 X1 R0 Z-1 F1", "a canned cycle has a way of many moves"},
           {"G81 X1 Z-1", "the first block of a canned cycle needs R"},
           {"G81 X1 R0", "the first block of a canned cycle needs Z"},
           {"G82 X1 R0 Z-1", "the first block of a canned cycle needs P"},
           {"G83 X1 R0 Z-1", "the first block of a canned cycle needs Q"},
           {"G81 R0", "a canned cycle needs X, Y or Z"},
           {"G53 G81 X1 R0 Z-1", "G53 goes with G0 and G1 only"},
           {"G86 X1 R0 Z-1 P1", "G86 stops the spindle, which does not turn"},
           {"G41.1 G1 X9", "G41.1 and G42.1 need D"},
           {"G41 G1 X9", "does not say which tool is in the spindle"},
           {"G41 D2 G1 X9", "tool 2"},
           {"M62", "M62 needs P, the number of an output"},
           {"M66 L3 Q1", "M66 needs P"},
           {"M66 P0 Q1", "M66 is taken with L3 and L4"},
           {"M66 P0 L3", "M66 needs Q"},
           {"M98", "M98 needs P"},
           {"M98 P7 M3", "M98 has a block of its own"},
           {"M70 M3", "M70 has a block of its own"},
           {"M6", "M6 without a T before it"},
           {"G10 L2 X1", "G10 needs P, the work system"},
           {"G10 P1 X1", "of G10 there are L2 and L20"},
           {"G10 L2 P1 R5", "a work system that is turned (R) is not taken yet"},
           {"G92", "G92 needs X, Y or Z"},
           {"G52", "G52 needs X, Y or Z"},
           {"M50 P0", "overrides belong to the operator"},
           {"M53 P0", "overrides belong to the operator"},
           {"M52 P1", "overrides belong to the operator"},
           {"M52", "overrides belong to the operator"},
           {"#1=", "a number expected"},
           {"#1=[1+]", "a number expected"},
           {"#1 5", "= expected"},
           {"#1=ATAN[1]", "ATAN has two values: ATAN[y]/[x]"},
           {"#1=ATAN[1]2", "ATAN has two values: ATAN[y]/[x]"},
           {"G1 X1.2.3", "a number with more than one decimal point"},
           {"G80\nX1", "no G0, G1 or other motion is in force"},
           {"G80 N5", "a line's number stands at its begin"},
           {"G1 X1 O5", "an O word begins its line"},
           {"G1 U1", "axis U is not taken yet"},
           {"G1 V1", "axis V is not taken yet"},
           {"G1 W1", "axis W is not taken yet"},
           {"G1 X1 !", "a word begins with a letter, not with !"},
           {"G1 X1 ~", "a word begins with a letter, not with ~"},
           {"G1 X1 \x80", "a character that no program has"},
           {"O X1", "O is followed by a number, a <name> or [a value]"},
           {"o<> if[1]", "a name stands in < >"},
           {"o1 endwhile", "is open"},
           {"o1 else", "is open"},
           {"o1 endif", "is open"},
       })
    EXPECT_THAT(refused(lines), testing::HasSubstr(why)) << lines;
  for (const std::string taken :
       {"M50", "M50 P1", "M51", "M53 P1", "M52 P0", "M48", "G2 X4 R2", "G2 X4 R-3", "G90.1 G2 X4 I2 J0",
        "G5.1 X4 I2 J2", "G5.1 X4 I0 J2", "G81 X1 R0 Z-1", "M3 S100\nG86 X1 R0 Z-1 P1", "M62 P3", "M66 P0 L3 Q1"})
    EXPECT_EQ(refused(taken), "taken") << taken;
}

/// Whole turns of angles and their arcs: ATAN is within half a turn either way.
TEST(Rs274Expression, HasAnglesOfEveryQuarter) {
  for (int degrees = -179; degrees <= 180; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(value_of(fmt::format("[ATAN[{:.9f}]/[{:.9f}]]", std::sin(angle), std::cos(angle))), degrees, 1e-5)
        << degrees;
    EXPECT_NEAR(value_of(fmt::format("[SIN[{}]]", degrees)), std::sin(angle), 1e-6) << degrees;
    EXPECT_NEAR(value_of(fmt::format("[COS[{}]]", degrees)), std::cos(angle), 1e-6) << degrees;
  }
}

}  // namespace
}  // namespace rmac::rs274
