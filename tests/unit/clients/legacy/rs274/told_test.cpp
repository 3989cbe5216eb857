// What the control tells a program of itself, by the names that LinuxCNC gives to it.
#include <gmock/gmock.h>

#include <map>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

double told_after(const std::string& lines, const std::string& name) {
  return value_of("#9", lines + "\n#9=#<" + name + ">\nG80 G21 G90 G17\n");
}

TEST(Rs274Told, ModesAreWhatThePrecedingBlocksMadeThem) {
  EXPECT_EQ(told_after("", "_metric"), 1);
  EXPECT_EQ(told_after("G20", "_imperial"), 1);
  EXPECT_EQ(told_after("G91", "_Absolute"), 0);
  EXPECT_EQ(told_after("G91", "_incremental"), 1);
  EXPECT_EQ(told_after("G18", "_plane"), 180);
  EXPECT_EQ(told_after("G1 X3", "_motion_mode"), 10);
  EXPECT_EQ(told_after("G80", "_motion_mode"), 800);
  EXPECT_EQ(told_after("G90.1", "_ijk_absolute_mode"), 1);
  EXPECT_EQ(told_after("G99", "_retract_r_plane"), 1);
  EXPECT_EQ(told_after("G98", "_retract_old_z"), 1);
  EXPECT_EQ(told_after("F123", "_feed"), 123);
  EXPECT_EQ(told_after("G10 L2 P1 X0 Y0 Z0\nG10 L2 P9 X0 Y0 Z0\nG59.3\nG0 X0 Y0 Z0", "_coord_system"), 593);
}

/// Each name that says one of two things, after what makes it so and after what does not.
TEST(Rs274Told, ModesAreTrueWhereTheyHoldAndElseNot) {
  struct Mode {
    std::string name, holds, does_not;
  };
  for (const auto& [name, holds, does_not] : std::vector<Mode>{
           {"_metric", "G21", "G20"},
           {"_imperial", "G20", "G21"},
           {"_absolute", "G90", "G91"},
           {"_incremental", "G91", "G90"},
           {"_ijk_absolute_mode", "G90.1", "G91.1"},
           {"_retract_r_plane", "G99", "G98"},
           {"_retract_old_z", "G98", "G99"},
           {"_inverse_time", "G93", "G94"},
           {"_units_per_minute", "G94", "G93"},
           {"_spindle_on", "M3 S5", "M5"},
           {"_spindle_on", "M4 S5", "M3 S5\nM5"},
           {"_spindle_cw", "M3 S5", "M4 S5"},
           {"_spindle_cw", "M3 S5", "M5"},
           {"_mist", "M7", "M9"},
           {"_mist", "M7\nM8", "M8"},
           {"_flood", "M8", "M9"},
           {"_flood", "M8\nM7", "M7"},
       }) {
    EXPECT_EQ(told_after(holds, name), 1) << name << " after " << holds;
    EXPECT_EQ(told_after(does_not, name), 0) << name << " after " << does_not;
  }
  for (const auto& [code, tenfold] : std::map<std::string, int>{{"G17", 170}, {"G18", 180}, {"G19", 190}})
    EXPECT_EQ(told_after(code, "_plane"), tenfold);
  for (const std::string always_one :
       {"_spindle_rpm_mode", "_lathe_radius_mode", "_speed_override", "_feed_override", "_feed_hold"})
    EXPECT_EQ(told_after("", always_one), 1) << always_one;
  for (const std::string always_zero :
       {"_units_per_rev", "_spindle_css_mode", "_lathe_diameter_mode", "_adaptive_feed"})
    EXPECT_EQ(told_after("", always_zero), 0) << always_zero;
  const std::vector<std::pair<std::string, int>> systems{{"G54", 540},   {"G55", 550},   {"G56", 560},
                                                         {"G57", 570},   {"G58", 580},   {"G59", 590},
                                                         {"G59.1", 591}, {"G59.2", 592}, {"G59.3", 593}};
  for (std::size_t at = 0; at < systems.size(); ++at) {
    const auto begin =
        fmt::format("G10 L2 P1 X0 Y0 Z0\nG10 L2 P{} X0 Y0 Z0\n{}\nG0 X0 Y0 Z0", at + 1, systems[at].first);
    EXPECT_EQ(told_after(begin, "_coord_system"), systems[at].second);
    EXPECT_EQ(value_of("#9", begin + "\n#9=#5220\n"), static_cast<double>(at + 1));
  }
}

TEST(Rs274Told, PlacesAreNumbersToo) {
  EXPECT_EQ(value_of("#9", "G0 X1 Y2 Z3\n#9=#5420\n"), 1);
  EXPECT_EQ(value_of("#9", "G0 X1 Y2 Z3\n#9=#5421\n"), 2);
  EXPECT_EQ(value_of("#9", "G0 X1 Y2 Z3\n#9=#5422\n"), 3);
  for (const int beside : {5419, 5423, 5219, 5221, 5399, 5401})
    EXPECT_THAT(refusal_of(program_of(fmt::format("G0 X#{}", beside))),
                HasSubstr("is the control's own, and not known here"))
        << beside;
}

TEST(Rs274Told, PlacesAreThoseOfTheProgramInItsUnit) {
  EXPECT_EQ(told_after("G0 X25.4 Y2\nG20", "_x"), 1);
  EXPECT_EQ(told_after("G0 X5 Y2", "_y"), 2);
  EXPECT_EQ(told_after("G92 Z3", "_z"), 3);
}

TEST(Rs274Told, SwitchesAreAsTheProgramSetThem) {
  EXPECT_EQ(told_after("M4 S500", "_spindle_on"), 1);
  EXPECT_EQ(told_after("M4 S500", "_spindle_cw"), 0);
  EXPECT_EQ(told_after("M3 S500", "_spindle_cw"), 1);
  EXPECT_EQ(told_after("M3 S500", "_rpm"), 500);
  EXPECT_EQ(told_after("M8", "_flood"), 1);
  EXPECT_EQ(told_after("M8\nM9", "_flood"), 0);
  EXPECT_EQ(told_after("M7", "_mist"), 1);
  EXPECT_EQ(told_after("T3", "_selected_tool"), 3);
}

TEST(Rs274Told, AProgramKnowsWhereItIsAndThatItMovesAMachine) {
  EXPECT_EQ(told_after("", "_task"), 1) << "0 is for previews";
  EXPECT_EQ(told_after("", "_call_level"), 0);
  EXPECT_EQ(told_after("o1 sub\n#5=#<_call_level>\n#100=#5\no1 endsub\no1 call\n#<_a_name>=#100", "_a_name"), 1);
  EXPECT_EQ(told_after("", "_line"), 4);
}

TEST(Rs274Told, WhatNobodyKnowsIsRefusedAndNothingOfItIsSet) {
  EXPECT_THAT(refusal_of(program_of("G0 X#<_current_pocket>")), StartsWith("3:5: #<_CURRENT_POCKET> is the control's"));
  EXPECT_THAT(refusal_of("G0 X#<_metric>"), HasSubstr("not known here"));
  EXPECT_THAT(refusal_of(program_of("#<_x>=3")), HasSubstr("give yours another name"));
  EXPECT_THAT(refusal_of(program_of("T1 M6\nG43 G0 X#<_x> Y0 Z0")), HasSubstr("not known here"));
  EXPECT_EQ(value_of("EXISTS[#<_x>]"), 1);
  EXPECT_EQ(value_of("EXISTS[#<_u>]"), 0);
  EXPECT_EQ(value_of("7", "#5599=0\n"), 7) << "whether debugging is shown";
}

}  // namespace
}  // namespace rmac::rs274
