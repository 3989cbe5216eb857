#include "clients/legacy/rs274/blocks/codes.hpp"

#include <algorithm>
#include <array>

namespace rmac::rs274 {

using gcode::GCode, gcode::GGroup, gcode::MCode, gcode::MGroup;

namespace {

constexpr std::string_view kCycle = "a cycle that needs the spindle's angle or a hand; write it out as G0 and G1";
constexpr std::string_view kHome =
    "a program does not set the machine's points; give --reference-point when it is imported";
constexpr std::string_view kLathe = "lathes are not taken yet";
constexpr std::string_view kThread = "moves that follow the spindle's angle are not taken";
constexpr std::string_view kPolar = "polar coordinates are not taken; write X and Y";
constexpr std::string_view kFeed = "feed is taken in mm or inch a minute (G94); have the CAM program write F so";
constexpr std::string_view kAxis = "there are no axes U V W";

// By number, for the search.
constexpr auto kG = std::to_array<GCode>({
    {0, GGroup::Motion, {}},
    {10, GGroup::Motion, {}},
    {20, GGroup::Motion, {}},
    {30, GGroup::Motion, {}},
    {40, GGroup::Once, {}},
    {50, GGroup::Motion, {}},
    {51, GGroup::Motion, {}},
    {52, GGroup::Motion, {}},
    {53, GGroup::Motion, {}},
    {70, GGroup::Once, kLathe},
    {80, GGroup::Once, kLathe},
    {100, GGroup::Once, {}},
    {160, GGroup::Distance, kPolar},
    {170, GGroup::Plane, {}},
    {171, GGroup::Plane, kAxis},
    {180, GGroup::Plane, {}},
    {181, GGroup::Plane, kAxis},
    {190, GGroup::Plane, {}},
    {191, GGroup::Plane, kAxis},
    {200, GGroup::Units, {}},
    {210, GGroup::Units, {}},
    {280, GGroup::Once, {}},
    {281, GGroup::Once, kHome},
    {300, GGroup::Once, {}},
    {301, GGroup::Once, kHome},
    {330, GGroup::Motion, kThread},
    {331, GGroup::Motion, kThread},
    {382, GGroup::Motion, gcode::kProbing},
    {383, GGroup::Motion, gcode::kProbing},
    {384, GGroup::Motion, gcode::kProbing},
    {385, GGroup::Motion, gcode::kProbing},
    {400, GGroup::Radius, {}},
    {410, GGroup::Radius, {}},
    {411, GGroup::Radius, {}},
    {420, GGroup::Radius, {}},
    {421, GGroup::Radius, {}},
    {430, GGroup::Length, {}},
    {431, GGroup::Length, "tool lengths are those of the appliance's tool table (rmac tools); write G43 H"},
    {432, GGroup::Length, "a second tool length is not taken; put it into the appliance's tool table (rmac tools)"},
    {490, GGroup::Length, {}},
    {520, GGroup::Once, {}},
    {530, GGroup::Once, {}},
    {540, GGroup::System, {}},
    {550, GGroup::System, {}},
    {560, GGroup::System, {}},
    {570, GGroup::System, {}},
    {580, GGroup::System, {}},
    {590, GGroup::System, {}},
    {591, GGroup::System, {}},
    {592, GGroup::System, {}},
    {593, GGroup::System, {}},
    {610, GGroup::Control, {}},
    {611, GGroup::Control, "an exact stop behind every block is not taken; G61 stops wherever the path is not smooth"},
    {640, GGroup::Control, {}},
    {gcode::kInchOfMach, GGroup::Units, {}},
    {gcode::kMmOfMach, GGroup::Units, {}},
    {730, GGroup::Motion, {}},
    {740, GGroup::Motion, kThread},
    {760, GGroup::Motion, kThread},
    {800, GGroup::Motion, {}},
    {810, GGroup::Motion, {}},
    {820, GGroup::Motion, {}},
    {830, GGroup::Motion, {}},
    {840, GGroup::Motion, kThread},
    {850, GGroup::Motion, {}},
    {860, GGroup::Motion, {}},
    {870, GGroup::Motion, kCycle},
    {880, GGroup::Motion, kCycle},
    {890, GGroup::Motion, {}},
    {900, GGroup::Distance, {}},
    {901, GGroup::ArcDistance, {}},
    {910, GGroup::Distance, {}},
    {911, GGroup::ArcDistance, {}},
    {920, GGroup::Once, {}},
    {921, GGroup::Once, {}},
    {922, GGroup::Once, {}},
    {923, GGroup::Once, {}},
    {930, GGroup::Feed, {}},
    {940, GGroup::Feed, {}},
    {950, GGroup::Feed, kFeed},
    {960, GGroup::SpindleMode, "constant surface speed is not taken; write G97 and S in turns a minute"},
    {970, GGroup::SpindleMode, {}},
    {980, GGroup::Return, {}},
    {990, GGroup::Return, {}},
});

constexpr std::string_view kOutput = "the appliance has no analogue outputs";

constexpr auto kM = std::to_array<MCode>({
    {0, MGroup::Stop, {}},
    {1, MGroup::Stop, {}},
    {2, MGroup::Stop, {}},
    {3, MGroup::Spindle, {}},
    {4, MGroup::Spindle, {}},
    {5, MGroup::Spindle, {}},
    {6, MGroup::Tool, {}},
    {7, MGroup::Mist, {}},
    {8, MGroup::Flood, {}},
    {9, MGroup::CoolantOff, {}},
    {19, MGroup::Spindle, "turning the spindle to an angle is not taken"},
    {30, MGroup::Stop, {}},
    {48, MGroup::Override, {}},
    {49, MGroup::Override, gcode::kOverridesStay},
    {50, MGroup::Override, {}},
    {51, MGroup::Override, {}},
    {52, MGroup::Override, {}},
    {53, MGroup::Override, {}},
    {60, MGroup::Stop, {}},
    {61, MGroup::Tool, "which tool is in the spindle a person says with rmac confirm"},
    {62, MGroup::Io, {}},
    {63, MGroup::Io, {}},
    {64, MGroup::Io, {}},
    {65, MGroup::Io, {}},
    {66, MGroup::Io, {}},
    {67, MGroup::Override, kOutput},
    {68, MGroup::Override, kOutput},
    {70, MGroup::Override, {}},
    {71, MGroup::Override, {}},
    {72, MGroup::Override, {}},
    {73, MGroup::Override, {}},
    {98, MGroup::Stop, {}},
    {99, MGroup::Stop, {}},
});

}  // namespace

const GCode* find_g(int tenfold) noexcept {
  const auto* found = std::ranges::lower_bound(kG, tenfold, {}, &GCode::tenfold);
  return found != kG.end() && found->tenfold == tenfold ? found : nullptr;
}

const MCode* find_m(int number) noexcept {
  const auto* found = std::ranges::lower_bound(kM, number, {}, &MCode::number);
  return found != kM.end() && found->number == number ? found : nullptr;
}

}  // namespace rmac::rs274
