#include "clients/legacy/option_values.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

// What people type behind --offset, --rotary and their like: what is meant is read as it stands, and of all else
// nothing is kept.

namespace rmac {
namespace {

using Offsets = std::map<std::size_t, gcode::Known>;

const std::vector<std::string> kNoPoints{"",        "0",           "0,0",          "0,0,",    "0,0,0,",   "0,0,0,0",
                                         ",0,0",    " 0,0,0",      "0, 0,0",       "0,0,0 ",  "0;0;0",    "0 0 0",
                                         "+1,0,0",  "1e3,0,0",     "nan,0,0",      "0,inf,0", "0,0,-inf", "a,0,0",
                                         "0,0,0mm", "1000001,0,0", "0,-1000001,0", "0,0,0x10"};

TEST(OptionValues, APointIsThreeNumbersInTheirOrder) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> mm(-legacy::kFarthest_mm, legacy::kFarthest_mm);
  for (int i = 0; i < 200; ++i) {
    const legacy::Point wanted{mm(random), mm(random), mm(random)};
    const std::string text = fmt::format("{:f},{:f},{:f}", wanted[0], wanted[1], wanted[2]);
    const auto point = read_point(text);
    ASSERT_TRUE(point) << text;
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(point->at(axis), wanted.at(axis), 1e-6) << text;
  }
  EXPECT_EQ(read_point("1,-2.5,.5"), (legacy::Point{1, -2.5, 0.5}));
}

TEST(OptionValues, APointMayBeAtTheFarthestAndNoFarther) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      legacy::Point point{};
      point.at(axis) = sign * legacy::kFarthest_mm;
      EXPECT_EQ(read_point(fmt::format("{:f},{:f},{:f}", point[0], point[1], point[2])), point);
      point.at(axis) = sign * (legacy::kFarthest_mm + 0.001);
      EXPECT_EQ(read_point(fmt::format("{:f},{:f},{:f}", point[0], point[1], point[2])), std::nullopt);
    }
  }
}

TEST(OptionValues, WhatIsNoPointIsNone) {
  for (const auto& text : kNoPoints) EXPECT_EQ(read_point(text), std::nullopt) << text;
}

/// The system that an offset of 1, 2 and 3 mm counts for, -1 where it is refused; nothing is kept then.
int system_named(const std::string& name, const FurtherSystems& further = {}) {
  Offsets offsets;
  const bool taken = read_offset(name + "=1,2,3", further, offsets);
  EXPECT_EQ(offsets.size(), taken ? 1U : 0U) << name;
  if (!taken) return -1;
  EXPECT_EQ(offsets.begin()->second, (gcode::Known{1, 2, 3})) << name;
  return static_cast<int>(offsets.begin()->first);
}

TEST(OptionValues, WorkSystemsCountFromG54AndThoseOfTheLanguageFollowG59) {
  for (int i = 0; i < 6; ++i) EXPECT_EQ(system_named(fmt::format("G{}", 54 + i)), i);
  const std::vector<FurtherSystems> languages{{}, {"G54.1P", 300}, {"G154P", 99}};
  for (const auto& further : languages) {
    for (int i = 1; i <= further.most; ++i)
      EXPECT_EQ(system_named(fmt::format("{}{}", further.prefix, i), further), 5 + i);
    for (const int none : {-1, 0, further.most + 1, 100'000})
      EXPECT_EQ(system_named(fmt::format("{}{}", further.prefix, none), further), -1) << further.prefix << none;
  }
}

TEST(OptionValues, OtherNamesAreNoWorkSystems) {
  for (const std::string name :
       {"",     "G",    "G5",  "G53",  "G60",   "G054",   "G540",  "g54",     "X54",    "54",    " G54",
        "G54 ", "G 54", "G5x", "G59.", "G59.x", "G59.1x", "G59.4", "G54.1P1", "G154P1", "G54.1", "G-4"})
    EXPECT_EQ(system_named(name), -1) << name;
}

TEST(OptionValues, AnOffsetWithoutAPointIsRefusedAndWhatWasGivenStays) {
  Offsets offsets{{0, {7, 8, 9}}};
  for (const auto& text : kNoPoints) EXPECT_FALSE(read_offset("G54=" + text, {}, offsets)) << text;
  for (const std::string text : {"", "G54", "G54:1,2,3", "1,2,3", "=1,2,3", "G54==1,2,3"})
    EXPECT_FALSE(read_offset(text, {}, offsets)) << text;
  EXPECT_EQ(offsets, (Offsets{{0, {7, 8, 9}}}));
  EXPECT_TRUE(read_offset("G54=1,2,3", {}, offsets));  // the later of two
  EXPECT_EQ(offsets, (Offsets{{0, {1, 2, 3}}}));
}

TEST(OptionValues, CommonVariablesAreThoseThatAFanucHas) {
  for (int number = -10; number < 1100; ++number) {
    std::map<int, double> variables;
    const bool is_common = (100 <= number && number <= 199) || (500 <= number && number <= 999);
    EXPECT_EQ(read_variable(fmt::format("{}=-12.5", number), variables), is_common) << number;
    EXPECT_EQ(variables, is_common ? (std::map<int, double>{{number, -12.5}}) : (std::map<int, double>{}));
  }
}

const std::vector<std::string> kNotNumbered{"",      "500",    "=1",     "500=",   "500 =1",  "500= 1",
                                            "x=1",   "#500=1", "500=x",  "500=1x", "500=1,5", "500=1e1",
                                            "5.5=1", "500=+1", "+500=1", "500==1"};

TEST(OptionValues, WhatIsNoVariableIsRefusedAndTheFirstOfTwoStays) {
  std::map<int, double> variables{{501, 1}};
  for (const auto& text : kNotNumbered) EXPECT_FALSE(read_variable(text, variables)) << text;
  for (const std::string text : {"500=nan", "500=inf", "500=-inf", "501=2"})
    EXPECT_FALSE(read_variable(text, variables)) << text;
  EXPECT_EQ(variables, (std::map<int, double>{{501, 1}}));
}

TEST(OptionValues, ToolsHaveDiametersUpToAMetre) {
  std::map<int, double> diameters;
  for (const std::string text : {"0=0", "1=1000", "2=0.001", "99999=12.7"})
    EXPECT_TRUE(read_diameter(text, diameters)) << text;
  const std::map<int, double> all{{0, 0}, {1, 1000}, {2, 0.001}, {99999, 12.7}};
  EXPECT_EQ(diameters, all);
  for (const auto& text : kNotNumbered) EXPECT_FALSE(read_diameter(text, diameters)) << text;
  for (const std::string text : {"-1=5", "5=-0.001", "5=1000.001", "5=nan", "5=inf", "1=3"})
    EXPECT_FALSE(read_diameter(text, diameters)) << text;
  EXPECT_EQ(diameters, all);
}

TEST(OptionValues, AnMCodeIsMAndAWholeNumber) {
  std::set<int> codes;
  for (const std::string text : {"M10", "M0", "M999"}) EXPECT_TRUE(read_m(text, codes)) << text;
  const std::set<int> all{0, 10, 999};
  EXPECT_EQ(codes, all);
  for (const std::string text :
       {"", "M", "10", "m10", "M-1", "M1.5", "M 10", "M10 ", " M10", "M+3", "Mx", "M10x", "M99999999999", "S3", "M10"})
    EXPECT_FALSE(read_m(text, codes)) << text;
  EXPECT_EQ(codes, all);
}

TEST(OptionValues, NamesAreAllThatFollowsTheirNumber) {
  std::map<int, std::string> names;
  for (const std::string text : {"3=Clamp", "0=x", "62=Air=On ", "7= "}) EXPECT_TRUE(read_name(text, names)) << text;
  const std::map<int, std::string> all{{0, "x"}, {3, "Clamp"}, {7, " "}, {62, "Air=On "}};
  EXPECT_EQ(names, all);
  for (const std::string text :
       {"", "4", "4=", "=Clamp", "Clamp", "-1=Clamp", "4 =Clamp", "4.5=Clamp", "x=Clamp", "3=Air", "99999999999=Clamp"})
    EXPECT_FALSE(read_name(text, names)) << text;
  EXPECT_EQ(names, all);
}

/// Letters and ways of axes as `--rotary` has them.
std::string said(const std::vector<gcode::RotaryAxis>& axes) {
  std::string text;
  for (const auto& axis : axes) text += fmt::format("{}{}{:g}", text.empty() ? "" : " ", axis.letter, axis.sign);
  return text;
}

TEST(OptionValues, RotaryAxesKeepTheirOrderAndTheWayTheyTurn) {
  EXPECT_EQ(said(read_rotary("C,A")), "C1 A1");
  EXPECT_EQ(said(read_rotary("C,-B")), "C1 B-1");
  EXPECT_EQ(said(read_rotary("-A,-B,-C")), "A-1 B-1 C-1");
  EXPECT_EQ(said(read_rotary("B")), "B1");
  for (const std::string text : {"", "-", ",", "C,", ",C", "C,,A", "CA", "C A", "C, A", "c", "D", "@", "--C", "C-",
                                 "C,C", "C,-C", "A,B,C,A", "C,X", "+C"})
    EXPECT_EQ(said(read_rotary(text)), "") << text;
}

TEST(OptionValues, ACentreIsOfTheAxisThatItNamesOrOfAll) {
  const legacy::Point one{1, 2, 3}, other{0, 0, -50};
  auto axes = read_rotary("C,-A");
  EXPECT_TRUE(read_rotary_centre("A=1,2,3", axes));
  EXPECT_EQ(axes.at(0).centre_mm, std::nullopt);
  EXPECT_EQ(axes.at(1).centre_mm, one);
  for (const auto& text : kNoPoints) {
    EXPECT_FALSE(read_rotary_centre(text, axes)) << text;
    EXPECT_FALSE(read_rotary_centre("C=" + text, axes)) << text;
  }
  for (const std::string text : {"B=1,2,3", "c=1,2,3", "=1,2,3", "AC=1,2,3", "A:1,2,3"})
    EXPECT_FALSE(read_rotary_centre(text, axes)) << text;
  EXPECT_EQ(axes.at(0).centre_mm, std::nullopt);
  EXPECT_EQ(axes.at(1).centre_mm, one);
  EXPECT_TRUE(read_rotary_centre("0,0,-50", axes));
  for (const auto& axis : axes) EXPECT_EQ(axis.centre_mm, other);
  std::vector<gcode::RotaryAxis> none;
  EXPECT_FALSE(read_rotary_centre("0,0,-50", none));
}

}  // namespace
}  // namespace rmac
