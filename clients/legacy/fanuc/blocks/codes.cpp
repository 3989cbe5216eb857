#include "clients/legacy/fanuc/blocks/codes.hpp"

#include <algorithm>
#include <array>

namespace rmac::fanuc {

namespace {

using gcode::GGroup, gcode::MGroup;

constexpr std::string_view kThread = "moves that follow the spindle's angle are not taken";
constexpr std::string_view kHand = "a cycle that needs the spindle's angle or a hand; write it out as G0 and G1";
constexpr std::string_view kFeed = "feed is taken in mm or inch a minute (G94); have the CAM program write F so";
constexpr std::string_view kPolar = "these polar coordinates are not taken; have the CAM program write X and Y, or G16";
constexpr std::string_view kCurve = "this curve is not taken; have the CAM program write lines and arcs";
constexpr std::string_view kSpace =
    "corrections in space are not taken; have the CAM program give the path of the tool's centre";
constexpr std::string_view kExact =
    "an exact stop behind one block is not taken; write G61 before it, and G64 behind it";
constexpr std::string_view kLength =
    "tool lengths are those of the appliance's tool table (rmac tools); write G43 H and the tool's number";
constexpr std::string_view kBegin = "this stands at the begin of its block, behind N alone";
constexpr std::string_view kUnits =
    "a Fanuc has G20 (inches) and G21 (mm) for this; have the post write those; bolt holes of a Haas' program "
    "--dialect haas knows";
constexpr std::string_view kTilt = "this way to tilt a plane is not taken; have the post write Euler's angles, G68.2";
constexpr std::string_view kLimits = "which room the machine has, the appliance knows; take it out";
constexpr std::string_view kSurface = "constant surface speed is not taken; write G97 and S in turns a minute";

// By number, for the search.
constexpr auto kG = std::to_array<FanucG>({
    {{0, GGroup::Motion, {}}},
    {{10, GGroup::Motion, {}}},
    {{20, GGroup::Motion, {}}},
    {{30, GGroup::Motion, {}}},
    {{40, GGroup::Once, {}}},
    {{50, GGroup::Once, {}}, Use::LookAhead},
    {{51, GGroup::Once, {}}, Use::LookAhead},
    {{61, GGroup::Motion, kCurve}},
    {{62, GGroup::Motion, kCurve}},
    {{71, GGroup::Once, kPolar}},
    {{80, GGroup::Once, {}}, Use::LookAhead},
    {{90, GGroup::Once, kExact}},
    {{100, GGroup::Once, {}}},
    {{110, GGroup::Once, {}}, Use::Nothing},
    {{121, GGroup::Once, kPolar}},
    {{131, GGroup::Once, {}}, Use::Nothing},
    {{150, GGroup::Once, {}}, Use::PolarOff},
    {{160, GGroup::Once, {}}, Use::PolarOn},
    {{170, GGroup::Plane, {}}},
    {{180, GGroup::Plane, {}}},
    {{190, GGroup::Plane, {}}},
    {{200, GGroup::Units, {}}},
    {{210, GGroup::Units, {}}},
    {{220, GGroup::Once, kLimits}},
    {{230, GGroup::Once, {}}, Use::Nothing},
    {{250, GGroup::Once, {}}, Use::Nothing},
    {{270, GGroup::Once, "the check of the reference point is not taken; write G28"}},
    {{280, GGroup::Once, {}}},
    {{290, GGroup::Once, "the way back from the reference point is not taken; write it as G0"}},
    {{300, GGroup::Once, {}}},
    {{310, GGroup::Motion, gcode::kProbing}},
    {{330, GGroup::Motion, kThread}},
    {{370, GGroup::Once, gcode::kProbing}},
    {{400, GGroup::Radius, {}}},
    {{401, GGroup::Once, {}}, Use::Nothing},
    {{410, GGroup::Radius, {}}},
    {{412, GGroup::Radius, kSpace}},
    {{420, GGroup::Radius, {}}},
    {{422, GGroup::Radius, kSpace}},
    {{430, GGroup::Length, {}}},
    {{431, GGroup::Length, "a length along a tilted axis is not taken; write G43.5, whose I, J and K are the axis"}},
    {{434, GGroup::Length, {}}},
    {{435, GGroup::Length, {}}},
    {{440, GGroup::Length, kLength}},
    {{450, GGroup::Once, kLength}},
    {{460, GGroup::Once, kLength}},
    {{470, GGroup::Once, kLength}},
    {{480, GGroup::Once, kLength}},
    {{490, GGroup::Length, {}}},
    {{491, GGroup::Once, {}}, Use::Nothing},
    {{500, GGroup::Once, {}}, Use::Nothing},
    {{501, GGroup::Mirror, {}}},
    {{510, GGroup::Once, "scaling is not taken; have the CAM program write the part in its size"}},
    {{511, GGroup::Mirror, {}}},
    {{520, GGroup::Once, {}}},
    {{530, GGroup::Once, {}}},
    {{531, GGroup::Once, {}}},
    {{536, GGroup::Once, {}}},
    {{540, GGroup::System, {}}},
    {{541, GGroup::System, {}}},
    {{550, GGroup::System, {}}},
    {{560, GGroup::System, {}}},
    {{570, GGroup::System, {}}},
    {{580, GGroup::System, {}}},
    {{590, GGroup::System, {}}},
    {{600, GGroup::Once, "positioning from one side is not taken; the appliance compensates play itself"}},
    {{610, GGroup::Control, {}}},
    {{620, GGroup::Control, {}}},
    {{630, GGroup::Control, kThread}},
    {{640, GGroup::Control, {}}},
    {{650, GGroup::Once, kBegin}},
    {{660, GGroup::Once, kBegin}},
    {{661, GGroup::Once, "a call behind every block is not taken; write G66, which calls behind moves"}},
    {{670, GGroup::Once, {}}, Use::EndOfModalCall},
    {{680, GGroup::Turn, {}}},
    {{682, GGroup::Turn, {}}},
    {{683, GGroup::Turn, kTilt}},
    {{684, GGroup::Turn, kTilt}},
    {{690, GGroup::Turn, {}}},
    {{700, GGroup::Units, kUnits}},
    {{710, GGroup::Units, kUnits}},
    {{730, GGroup::Motion, {}}},
    {{740, GGroup::Motion, kThread}},
    {{760, GGroup::Motion, kHand}},
    {{800, GGroup::Motion, {}}},
    {{810, GGroup::Motion, {}}},
    {{820, GGroup::Motion, {}}},
    {{830, GGroup::Motion, {}}},
    {{840, GGroup::Motion, kThread}},
    {{842, GGroup::Motion, kThread}},
    {{843, GGroup::Motion, kThread}},
    {{850, GGroup::Motion, {}}},
    {{860, GGroup::Motion, {}}},
    {{870, GGroup::Motion, kHand}},
    {{880, GGroup::Motion, kHand}},
    {{890, GGroup::Motion, {}}},
    {{900, GGroup::Distance, {}}},
    {{910, GGroup::Distance, {}}},
    {{920, GGroup::Once, {}}},
    {{921, GGroup::Once, {}}},
    {{930, GGroup::Feed, {}}},
    {{940, GGroup::Feed, {}}},
    {{950, GGroup::Feed, kFeed}},
    {{960, GGroup::SpindleMode, kSurface}},
    {{970, GGroup::SpindleMode, {}}},
    {{980, GGroup::Return, {}}},
    {{990, GGroup::Return, {}}},
    {{1030, GGroup::Once, {}}, Use::LookAhead},
    {{1870, GGroup::Once, {}}, Use::LookAhead},
});

constexpr std::string_view kTurn =
    "turning the spindle to an angle is not taken; where the program may go without, give --pass-over M19";

constexpr auto kM = std::to_array<gcode::MCode>({
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
    {19, MGroup::Spindle, kTurn},
    {29, MGroup::Spindle, kThread},
    {30, MGroup::Stop, {}},
    {48, MGroup::Override, {}},
    {49, MGroup::Override, gcode::kOverridesStay},
    {198, MGroup::Stop, "a program of another memory is not read; write it into this file, and M98"},
});

}  // namespace

const FanucG* find_g(int tenfold) noexcept {
  const auto* found = std::ranges::lower_bound(kG, tenfold, {}, [](const FanucG& entry) { return entry.code.tenfold; });
  return found != kG.end() && found->code.tenfold == tenfold ? found : nullptr;
}

const gcode::MCode* find_m(int number) noexcept {
  const auto* found = std::ranges::lower_bound(kM, number, {}, &gcode::MCode::number);
  return found != kM.end() && found->number == number ? found : nullptr;
}

}  // namespace rmac::fanuc
