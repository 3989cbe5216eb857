// What the control tells a program of itself, by the names that LinuxCNC gives to it.
#include <gmock/gmock.h>

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
