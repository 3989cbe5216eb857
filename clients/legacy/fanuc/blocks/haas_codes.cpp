#include "clients/legacy/fanuc/blocks/haas_codes.hpp"

#include <algorithm>
#include <array>

namespace rmac::fanuc {

namespace {

using M = HaasM::Use;

constexpr std::string_view kHaasPocket =
    "a pocket of any shape is not taken; have the CAM program write its moves, or clear it in FreeCAD";
constexpr std::string_view kHaasText = "engraving is not taken; have the CAM program write the letters as moves";
constexpr std::string_view kHaasRound = "moves around a cylinder are not taken; have the CAM program write X and A";
constexpr std::string_view kHaasTilt =
    "this way to tilt a plane is not taken; have the post write G234, under which X, Y and Z are those of the tip "
    "on the part";
constexpr std::string_view kHaasSpace =
    "corrections in space are not taken; have the CAM program give the path of the tool's centre";
constexpr std::string_view kHaasRow =
    "at which hole its row begins, manuals leave open; write the cycle at the first hole, and behind it G91 X Y L, "
    "with the way to the next and how many follow";
constexpr std::string_view kHaasLength = "a length along a tilted axis is not taken; have the post write G234";

/// A code of the Fanuc's table, or another, by the number that a Haas gives it.
struct Entry {
  int tenfold = 0;
  FanucG g;
};

constexpr Entry cycle(int tenfold) {
  return {tenfold, {{tenfold, gcode::GGroup::Once, {}}, Use::HaasCycle}};
}
constexpr Entry system(int tenfold) {
  return {tenfold, {{tenfold, gcode::GGroup::System, {}}}};
}
constexpr Entry refused(int tenfold, std::string_view why) {
  return {tenfold, {{tenfold, gcode::GGroup::Once, why}}};
}
constexpr Entry nothing(int tenfold) {
  return {tenfold, {{tenfold, gcode::GGroup::Once, {}}, Use::Nothing}};
}

// By number, for the search.
constexpr auto kHaasG = std::to_array<Entry>({
    cycle(120),
    cycle(130),
    refused(350, gcode::kProbing),
    refused(360, gcode::kProbing),
    refused(470, kHaasText),
    cycle(700),
    cycle(710),
    refused(720, kHaasRow),
    nothing(1000),
    refused(1010, "this mirror is not taken; have the CAM program write the part as it lies"),
    refused(1070, kHaasRound),
    system(1100),
    system(1110),
    system(1120),
    system(1130),
    system(1140),
    system(1150),
    system(1160),
    system(1170),
    system(1180),
    system(1190),
    system(1200),
    system(1210),
    system(1220),
    system(1230),
    system(1240),
    system(1250),
    system(1260),
    system(1270),
    system(1280),
    system(1290),
    refused(1360, gcode::kProbing),
    refused(1410, kHaasSpace),
    refused(1430, kHaasLength),
    refused(1500, kHaasPocket),
    system(1540),
    {2340, {{434, gcode::GGroup::Length, {}}}},
    refused(2530, kHaasTilt),
    refused(2540, kHaasTilt),
    nothing(2550),
    refused(2680, kHaasTilt),
    nothing(2690),
});
static_assert(std::ranges::is_sorted(kHaasG, {}, &Entry::tenfold));

constexpr std::string_view kHaasDoor = "doors and pallets are not the appliance's, and nothing moves them";

constexpr auto kHaasM = std::to_array<HaasM>({
    {7, M::Refused, 0, "the shower of a Haas washes chips away, and is no mist; write M8 for coolant"},
    {10, M::Nothing, 0, {}},
    {11, M::Nothing, 0, {}},
    {12, M::Nothing, 0, {}},
    {13, M::Nothing, 0, {}},
    {16, M::As, 6, {}},
    {17, M::Refused, 0, kHaasDoor},
    {18, M::Refused, 0, kHaasDoor},
    {31, M::Nothing, 0, {}},
    {32, M::Nothing, 0, {}},
    {33, M::Nothing, 0, {}},
    {34, M::Nothing, 0, {}},
    {35, M::Nothing, 0, {}},
    {41, M::Nothing, 0, {}},
    {42, M::Nothing, 0, {}},
    {50, M::Refused, 0, kHaasDoor},
    {73, M::SwitchOn, 0, "air through the tool"},
    {74, M::SwitchOff, 73, {}},
    {80, M::Refused, 0, kHaasDoor},
    {81, M::Refused, 0, kHaasDoor},
    {83, M::SwitchOn, 0, "the air jet"},
    {84, M::SwitchOff, 83, {}},
    {88, M::SwitchOn, 0, "coolant through the spindle"},
    {89, M::SwitchOff, 88, {}},
    {96, M::Refused, 0, "nothing goes by what an input is when the program runs; write the program without the jump"},
    {104, M::Refused, 0, gcode::kProbing},
    {105, M::Nothing, 0, {}},
    {109, M::Refused, 0, "nobody is asked while the program runs; write M0 with a message"},
    {130, M::Nothing, 0, {}},
    {131, M::Nothing, 0, {}},
    {138, M::Refused, 0, "the spindle's speed is not varied; write M138 out where the cut does not chatter"},
    {139, M::Nothing, 0, {}},
    {158, M::Nothing, 0, {}},
    {159, M::Nothing, 0, {}},
});
static_assert(std::ranges::is_sorted(kHaasM, {}, &HaasM::number));

}  // namespace

const FanucG* find_haas_g(int tenfold) noexcept {
  const auto* found = std::ranges::lower_bound(kHaasG, tenfold, {}, &Entry::tenfold);
  return found != kHaasG.end() && found->tenfold == tenfold ? &found->g : nullptr;
}

const HaasM* find_haas_m(int number) noexcept {
  const auto* found = std::ranges::lower_bound(kHaasM, number, {}, &HaasM::number);
  return found != kHaasM.end() && found->number == number ? found : nullptr;
}

}  // namespace rmac::fanuc
