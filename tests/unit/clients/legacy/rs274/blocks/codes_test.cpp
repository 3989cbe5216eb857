#include "clients/legacy/rs274/blocks/codes.hpp"

#include <gtest/gtest.h>

#include "unit/clients/legacy/gcode/code_lists.hpp"

// The codes of LinuxCNC's manual, by the modal groups that it puts them in: two of one group do not stand in a block.

namespace rmac::rs274 {
namespace {

using gcode::g_codes, gcode::GGroup, gcode::m_codes, gcode::MGroup, gcode::of_group;

TEST(Rs274Codes, AreInTheGroupsOfTheManual) {
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Motion)),
            "0 1 2 3 5 5.1 5.2 5.3 33 33.1 38.2 38.3 38.4 38.5 73 74 76 80 81 82 83 84 85 86 87 88 89");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Once)), "4 7 8 10 28 28.1 30 30.1 52 53 92 92.1 92.2 92.3");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Plane)), "17 17.1 18 18.1 19 19.1");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Distance)), "16 90 91");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::ArcDistance)), "90.1 91.1");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Feed)), "93 94 95");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Units)), "20 21 70 71") << "G70 and G71 are Mach's";
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Radius)), "40 41 41.1 42 42.1");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Length)), "43 43.1 43.2 49");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Return)), "98 99");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::System)), "54 55 56 57 58 59 59.1 59.2 59.3");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Control)), "61 61.1 64");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::SpindleMode)), "96 97");
  EXPECT_EQ(g_codes(find_g, of_group(GGroup::Turn)) + g_codes(find_g, of_group(GGroup::Mirror)), "");

  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Stop)), "0 1 2 30 60 98 99");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Spindle)), "3 4 5 19");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Tool)), "6 61");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Mist)), "7");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Flood)), "8");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::CoolantOff)), "9");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Override)), "48 49 50 51 52 53 67 68 70 71 72 73");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Io)), "62 63 64 65 66");
}

TEST(Rs274Codes, ThatTheApplianceCannotCarryOutAreRefusedWithWhatToDo) {
  EXPECT_EQ(g_codes(find_g, gcode::kIsRefused),
            "7 8 16 17.1 18.1 19.1 28.1 30.1 33 33.1 38.2 38.3 38.4 38.5 43.1 43.2 61.1 74 76 84 87 88 95 96");
  EXPECT_EQ(m_codes(find_m, gcode::kIsRefused), "19 49 61 67 68");
}

TEST(Rs274Codes, OfOtherControlsThatEndWhatNeverBeginsAreThree) {
  const auto itself = [](int tenfold) {
    static int number = 0;
    number = tenfold;
    return ends_nothing(tenfold) ? &number : nullptr;
  };
  EXPECT_EQ(g_codes(itself, [](int) { return true; }), "15 50 69");
}

}  // namespace
}  // namespace rmac::rs274
