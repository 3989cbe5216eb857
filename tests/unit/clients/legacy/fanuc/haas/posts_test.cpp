#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/haas/imported.hpp"

// Whole programs as posts for a Haas write them, and people.

namespace rmac::fanuc::haas {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kOfAPost = R"(%
O01001 (PLATE)
(USING HIGH FEED G1 F5000. INSTEAD OF G0.)
(T1 D=12. CR=0. - ZMIN=-2. - FLAT END MILL)
N10 G90 G94 G17
N15 G21
N20 G53 G0 Z0.

(FACE1)
N25 T1 M6
N30 M130(face.png)
N35 S5000 M3
N40 G154 P1
N45 M31
N50 G103 P1
N55 G187 P1 E0.02
N60 M88
N65 G0 X56. Y-12.5 A0.
N70 G43 Z15. H1
N75 G103 P0
N80 G1 Z-2. F333.
N85 X0. F1000.
N90 G0 Z15.
N95 M89

(DRILL1)
N100 M5
N105 G53 G0 Z0.
N110 M1
N115 T2 M16
N120 S1200 M3
N125 G110
N130 M11
N135 M8
N140 G0 X10. Y10.
N145 G43 Z15. H2
N150 G98 G83 X10. Y10. Z-12. R2. Q3. F120.
N155 X20.
N160 G80
N165 M9
N170 M10
N175 M33
N180 G28
N185 M30
%
)";

Options of_a_shop() {
  Options options;
  options.approach_mm = {{0, 0, 50}};
  options.reference_mm = {{0, 0, 200}};
  options.offsets[0] = options.offsets[6] = {0, 0, 0};
  options.outputs = {{88, "ThroughSpindle"}};
  return options;
}

TEST(HaasPost, IsTaken) {
  const auto all = imported(kOfAPost, of_a_shop(), Dialect::Haas);
  EXPECT_EQ(std::ranges::count(all.methods, "DoToolChange"), 2);
  std::vector<std::string> switched;
  for (const auto& request : all.requests) {
    const std::string text = request.dump();
    if (text.find("ThroughSpindle") != std::string::npos) switched.push_back(text);
  }
  EXPECT_THAT(switched, ElementsAre(HasSubstr(R"("On":true)"), HasSubstr(R"("On":false)")));
}

TEST(HaasPost, IsToldOfByTheFanucsLanguage) {
  EXPECT_THAT(refusal_of(kOfAPost, of_a_shop()), StartsWith("11:5: M130 is a code"));
  for (const std::string code : {"G154 P1", "G12 I5.", "G150", "G234 H1", "M97 P1", "M88", "M31", "G70 I5. L3"})
    EXPECT_THAT(refusal_of(program_of(code)), HasSubstr("--dialect haas knows")) << code;
  EXPECT_THAT(refusal_of(program_of("M7777")), Not(HasSubstr("haas")));
  EXPECT_THAT(refusal_of(program_of("G777")), Not(HasSubstr("haas")));
}

TEST(HaasPost, HasItsWorkSystemsByTwoNames) {
  Options options;
  options.offsets[0] = {0, 0, 0};
  options.offsets[6] = {5, 0, 0};
  options.offsets[6 + 19] = {7, 0, 0};
  options.offsets[6 + 98] = {9, 0, 0};
  for (const std::string code : {"G154 P1", "G110"}) EXPECT_EQ(ends(code + "\nG0 Y1.", options)[0][0], -5) << code;
  for (const std::string code : {"G154 P20", "G129"}) EXPECT_EQ(ends(code + "\nG0 Y1.", options)[0][0], -7) << code;
  EXPECT_EQ(ends("G0 G154 P99 Y1.", options)[0][0], -9);
  EXPECT_THAT(ends("G10 L20 P2 X3. Y0 Z0\nG111\nG0 Y1.", options), ElementsAre(ElementsAre(-3, 1, 10)));
  EXPECT_THAT(refusal("G154 P3"), HasSubstr("set it by G10 L20 P3 X Y Z before, or give --offset G154P3"));
  EXPECT_THAT(refusal("G154"), HasSubstr("G154 needs P"));
  EXPECT_THAT(refusal("G154 P100"), HasSubstr("1 to 99"));
}

TEST(HaasPost, PointsTheToolByG234AsByG434) {
  Options options;
  options.rotary = {{'C', 1}, {'A', 1}};
  const std::string lines = "G0 X1. Y2. Z30. A20. C10.\nG1 X5. A30. F100.\nG49";
  const auto by_fanuc = imported(program_of("G43.4\n" + lines), options);
  EXPECT_THAT(refusal("G234 H1"), HasSubstr("T1 M6"));
  EXPECT_EQ(done("G234\n" + lines, options).requests, by_fanuc.requests);
}

TEST(HaasPost, GoesHomeByG28Alone) {
  EXPECT_THAT(ends("G28", of_a_shop()), ElementsAre(ElementsAre(0, 0, 200)));
  EXPECT_THAT(refusal_of(program_of("G28"), of_a_shop()), HasSubstr("needs X, Y or Z"));
}

TEST(HaasPost, TellsTheWorkSystemInForceWhereItHasOneNumber) {
  Options options;
  for (const std::size_t system : {0U, 5U, 6U}) options.offsets[system] = {0, 0, 0};
  EXPECT_EQ(ends("G59\nG0 X#4014 Y0 Z0", options)[0][0], 59);
  EXPECT_THAT(refusal("G154 P1\n#1=#4014", options), StartsWith("6:4: #4014 is one of those that are codes"));
}

TEST(HaasPost, TellsOfProbingInItsOwnMacros) {
  for (const std::string code : {"G65 P9023 A20. T1.", "G65 P9810 Z5.", "G65 P9995 W54."})
    EXPECT_THAT(refusal(code), HasSubstr("rmac measure PLAN.json --apply")) << code;
  EXPECT_THAT(refusal("G65 P8000"), Not(HasSubstr("measure")));
}

TEST(HaasPost, ChangesToolsByM16WhateverIsPassedOver) {
  Options options;
  options.passed_m = {16};
  EXPECT_THAT(done("T1 M16", options).methods, Contains("DoToolChange"));
}

TEST(HaasPost, HasG80BesideAPocketInItsHeader) {
  EXPECT_EQ(refusal("G80 G12 I5. Z-1. D0 F100."), "taken");
  EXPECT_EQ(refusal("G99 G81 Z-1. R2. F100.\nG80 G13 I5. Z-1. D0"), "taken");
}

TEST(HaasPost, IsToldWhereAPocketStandsBehindAnArc) {
  EXPECT_THAT(refusal("G2 X1. I.5 F100.\nG12 X0 Y0 I5. Z-1. D0"), StartsWith("6:1: G12 behind G2"));
  EXPECT_THAT(refusal("G2 X1. I.5 F100.\nG12 X0 Y0 I5. Z-1. D0"), HasSubstr("write G0 or G1 beside it"));
  EXPECT_EQ(refusal("G2 X1. I.5 F100.\nG1 G12 X0 Y0 I5. Z-1. D0"), "taken");
}

TEST(HaasPost, IsRefusedWithWhatToDo) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"G150 P100 X1. Y1. Z-1. Q.5 R1. I.3 J5. K.1 G41 D1 F10.", "have the CAM program write its moves"},
      {"G47 P0 (TEXT) X1. Y1.", "letters as moves"},
      {"G72 I5. J30. L4", "G91 X Y L"},
      {"G254", "write G234"},
      {"G268 X1. I10.", "write G234"},
      {"G36", "measuring plan"},
      {"G101 X0", "the part as it lies"},
      {"M96 P10 Q8", "--pass-over M96"},
      {"M109 P501", "write M0"},
      {"M104", "measuring plan"},
      {"M50", "M50: doors and pallets"},
      {"M80", "--pass-over M80"},
      {"M17", "--pass-over M17"},
      {"M7", "write M8"},
      {"M138", "--pass-over M138"},
      {"M21", "give --pass-over M21"},
      {"M19", "give --pass-over M19"},
      {"G84 Z-5. R1. F1.", "spindle's angle"},
  };
  for (const auto& [line, what] : cases) {
    EXPECT_THAT(refusal(line), StartsWith("5:1: ")) << line;
    EXPECT_THAT(refusal(line), HasSubstr(what)) << line;
  }
  Options options;
  options.passed_m = {7, 21, 50, 88, 138};
  for (const std::string line : {"M7", "M21", "M50", "M88\nM89", "M138"}) EXPECT_EQ(refusal(line, options), "taken");
}

TEST(HaasLocalCall, RunsLinesOfTheSameProgram) {
  const std::string subs = "N100 G91 G1 X1.\nN101 M99\nN200 M97 P100 L2\nM99\n";
  const auto xs = [&subs](const std::string& lines) {
    std::vector<double> all;
    for (const auto& end : ends(lines, {}, subs)) all.push_back(end[0]);
    return all;
  };
  EXPECT_THAT(xs("M97 P100"), ElementsAre(1));
  EXPECT_THAT(xs("M97 P100 L3\nX5."), ElementsAre(1, 2, 3, 8));
  EXPECT_THAT(xs("M97 P200 L2"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(xs("G0 X10. M97 P100"), ElementsAre(10, 11)) << "what stands beside it is done first";
  EXPECT_THAT(ends("M98 P7", {}, "O7\nM97 P5\nM99\nN5 G0 X4.\nM99\n"), ElementsAre(ElementsAre(4, 0, 10)));
}

TEST(HaasLocalCall, IsRefusedWhereItLeadsNowhere) {
  EXPECT_THAT(refusal("M97 P5"), StartsWith("5:1: there is no N5 in O1"));
  EXPECT_THAT(refusal("M97"), StartsWith("5:1: M97 needs P"));
  EXPECT_THAT(refusal("M97 P5", {}, "N5 G0 X1.\nM99\nN05 G0 X2.\nM99\n"),
              StartsWith("5:1: there is more than one N5 in O1"));
  EXPECT_THAT(refusal("N5 G0 X1.\nM97 P5", {}, "N5 M99\n"), HasSubstr("more than one N5"));
  EXPECT_EQ(refusal("M97 P5", {}, "N5 M99\nO2\nN5 M99\n"), "taken") << "another program has its own";
  EXPECT_THAT(refusal("M97 P5 L0", {}, "N5 M99\n"), HasSubstr("L of M97"));
  EXPECT_THAT(refusal("M97 P5", {}, "N5 G0 X1.\n"), StartsWith("8:1: the file ends within N5"));
  EXPECT_THAT(refusal("M97 P5", {}, "N5 M97 P5\nM99\n"), HasSubstr("Does it call itself"));
  EXPECT_THAT(refusal("M97 P5", {}, "WHILE[#1 LT 1] DO1\nN5 #1=1\nEND1\nM99\n"), HasSubstr("N5 is within a loop"));
  EXPECT_THAT(refusal("N5 M97 P5 L9999 M98"), HasSubstr("one of M97, M98 and M99"));
  EXPECT_THAT(refusal("N5 G0 X1.\nM99"), HasSubstr("M99 ends a program that M97, M98 or G65 called"));
}

}  // namespace
}  // namespace rmac::fanuc::haas
