#include "clients/legacy/fanuc/blocks/codes.hpp"

#include <gtest/gtest.h>

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "unit/clients/legacy/gcode/code_lists.hpp"

// The codes of a Fanuc's manual and of a Haas', by their modal groups, and what becomes of each.

namespace rmac::fanuc {
namespace {

using gcode::g_codes, gcode::GGroup, gcode::m_codes, gcode::MGroup, gcode::of_group;

std::string of_fanuc(GGroup group) {
  return g_codes(find_g, [group](const FanucG& g) { return g.code.group == group; });
}
std::string used(Use use) {
  return g_codes(find_g, [use](const FanucG& g) { return g.use == use && g.code.refusal.empty(); });
}

TEST(FanucCodes, AreInTheGroupsOfTheManual) {
  EXPECT_EQ(of_fanuc(GGroup::Motion), "0 1 2 3 6.1 6.2 31 33 73 74 76 80 81 82 83 84 84.2 84.3 85 86 87 88 89");
  EXPECT_EQ(of_fanuc(GGroup::Once),
            "4 5 5.1 7.1 8 9 10 11 12.1 13.1 15 16 22 23 25 27 28 29 30 37 40.1 45 46 47 48 49.1 50 51 52 53 53.1 53.6 "
            "60 65 66 66.1 67 92 92.1 103 187");
  EXPECT_EQ(of_fanuc(GGroup::Plane), "17 18 19");
  EXPECT_EQ(of_fanuc(GGroup::Distance), "90 91");
  EXPECT_EQ(of_fanuc(GGroup::ArcDistance), "");
  EXPECT_EQ(of_fanuc(GGroup::Feed), "93 94 95");
  EXPECT_EQ(of_fanuc(GGroup::Units), "20 21 70 71");
  EXPECT_EQ(of_fanuc(GGroup::Radius), "40 41 41.2 42 42.2");
  EXPECT_EQ(of_fanuc(GGroup::Length), "43 43.1 43.4 43.5 44 49");
  EXPECT_EQ(of_fanuc(GGroup::Return), "98 99");
  EXPECT_EQ(of_fanuc(GGroup::System), "54 54.1 55 56 57 58 59");
  EXPECT_EQ(of_fanuc(GGroup::Control), "61 62 63 64");
  EXPECT_EQ(of_fanuc(GGroup::SpindleMode), "96 97");
  EXPECT_EQ(of_fanuc(GGroup::Turn), "68 68.2 68.3 68.4 69");
  EXPECT_EQ(of_fanuc(GGroup::Mirror), "50.1 51.1");

  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Stop)), "0 1 2 30 198");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Spindle)), "3 4 5 19 29");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Tool)), "6");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Mist)), "7");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Flood)), "8");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::CoolantOff)), "9");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Override)), "48 49");
  EXPECT_EQ(m_codes(find_m, of_group(MGroup::Io)), "");
}

TEST(FanucCodes, ThatTheApplianceCannotCarryOutAreRefusedWithWhatToDo) {
  EXPECT_EQ(g_codes(find_g, [](const FanucG& g) { return !g.code.refusal.empty(); }),
            "6.1 6.2 7.1 9 12.1 22 27 29 31 33 37 41.2 42.2 43.1 44 45 46 47 48 51 60 63 65 66 66.1 68.3 68.4 70 71 74 "
            "76 84 84.2 84.3 87 88 95 96");
  EXPECT_EQ(m_codes(find_m, gcode::kIsRefused), "19 29 49 198");
}

TEST(FanucCodes, ThatNoBlockCarriesOutActAsTheyAreReadOrNotAtAll) {
  EXPECT_EQ(used(Use::Nothing), "11 13.1 23 25 40.1 49.1 50") << "these end what never begins here";
  EXPECT_EQ(used(Use::LookAhead), "5 5.1 8 103 187");
  EXPECT_EQ(used(Use::PolarOn), "16");
  EXPECT_EQ(used(Use::PolarOff), "15");
  EXPECT_EQ(used(Use::EndOfModalCall), "67");
  EXPECT_EQ(used(Use::HaasCycle), "");
}

std::string haas_g(Use use) {
  return g_codes(find_haas_g, [use](const FanucG& g) {
    return g.use == use && g.code.group == GGroup::Once && g.code.refusal.empty();
  });
}

TEST(HaasCodes, StandBesideThoseOfTheFanuc) {
  EXPECT_EQ(haas_g(Use::HaasCycle), "12 13 70 71");
  EXPECT_EQ(haas_g(Use::Nothing), "100 255 269");
  EXPECT_EQ(haas_g(Use::Block), "");
  EXPECT_EQ(g_codes(find_haas_g, [](const FanucG& g) { return g.code.group == GGroup::System; }),
            "110 111 112 113 114 115 116 117 118 119 120 121 122 123 124 125 126 127 128 129 154");
  EXPECT_EQ(g_codes(find_haas_g, [](const FanucG& g) { return !g.code.refusal.empty(); }),
            "35 36 47 72 101 107 136 141 143 150 253 254 268");
  EXPECT_EQ(g_codes(find_haas_g, [](const FanucG& g) { return g.code.group == GGroup::Length; }), "234");
  EXPECT_EQ(find_haas_g(2340)->code.tenfold, 434) << "G234 is what G43.4 is elsewhere";
  for (int tenfold = 0; tenfold < 3000; ++tenfold) {
    const FanucG* g = find_haas_g(tenfold);
    if (g == nullptr || tenfold == 2340) continue;
    EXPECT_EQ(g->code.tenfold, tenfold);
  }
}

std::string haas_m(HaasM::Use use) {
  return m_codes(find_haas_m, [use](const HaasM& m) { return m.use == use; });
}

TEST(HaasCodes, OfTheMachineSwitchOrMeanNothingOrAreRefused) {
  EXPECT_EQ(haas_m(HaasM::Use::Nothing), "10 11 12 13 31 32 33 34 35 41 42 105 130 131 139 158 159");
  EXPECT_EQ(haas_m(HaasM::Use::SwitchOn), "73 83 88");
  EXPECT_EQ(haas_m(HaasM::Use::SwitchOff), "74 84 89");
  EXPECT_EQ(haas_m(HaasM::Use::As), "16");
  EXPECT_EQ(haas_m(HaasM::Use::Refused), "7 17 18 50 80 81 96 104 109 138");
  for (int number = 0; number < 200; ++number) {
    const HaasM* m = find_haas_m(number);
    if (m == nullptr) continue;
    const bool says_something = m->use == HaasM::Use::SwitchOn || m->use == HaasM::Use::Refused;
    EXPECT_EQ(!m->message.empty(), says_something) << number;
    const int as = m->use == HaasM::Use::SwitchOff ? number - 1 : m->use == HaasM::Use::As ? 6 : 0;
    EXPECT_EQ(m->as, as) << number << ": what is switched off has the number before it; M16 is M6";
  }
}

}  // namespace
}  // namespace rmac::fanuc
