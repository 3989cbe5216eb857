#include "clients/legacy/gcode/compensation_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rmac::gcode {

namespace {

constexpr double kMostDiameter_mm = 1000;

/// The diameter in the table that whoever imports the program gives.
double diameter_of(int tool, const Options& options, std::size_t place) {
  const auto found = options.tool_diameters_mm.find(tool);
  if (found == options.tool_diameters_mm.end())
    refuse(place, fmt::format("the diameter of tool {0} is not known here; give --tool-diameter {0}=MM", tool));
  return found->second;
}

double diameter_of_tool(Block& block, const Code& code, const Options& options, const Modes& modes,
                        const Switches& switches) {
  const Word* word = block.find('D');
  if (code.number % 10 != 0) {
    if (word == nullptr) refuse(code.place, "G41.1 and G42.1 need D, the tool's diameter");
    if (const Word* orientation = block.find('L'); orientation != nullptr && orientation->value != 0)
      refuse(orientation->place, "the orientation of a turning tool is not taken: mills have none");
    const double value = modes.mm(*word);
    if (!(value >= 0 && value <= kMostDiameter_mm)) refuse(word->place, "a diameter is 0 to 1000 mm");
    return value;
  }
  if (word == nullptr || word->value == 0) {
    if (!switches.tool())
      refuse(code.place,
             "the program does not say which tool is in the spindle; write D with its number, or T M6 before");
    return diameter_of(*switches.tool(), options, code.place);
  }
  if (!(word->value > 0 && word->value < 1e6 && word->value == std::floor(word->value)))
    refuse(word->place, "D of G41 and G42 is the number of a tool; a diameter stands in G41.1 and G42.1");
  return diameter_of(static_cast<int>(word->value), options, word->place);
}

void set_register(const Word& word, Modes& modes, const Compensation& compensation) {
  if (!(word.value >= 0 && word.value < 1e6 && word.value == std::floor(word.value)))
    refuse(word.place, "D is the number of an offset");
  const int number = static_cast<int>(word.value);
  if (compensation.on() && number != modes.diameter_register)
    refuse(word.place, "another D while cutter radius compensation is on; write G40 before it");
  modes.diameter_register = number;
}

bool may_be_within(GGroup group, const Code& code, const Modes& modes) {
  switch (group) {
    case GGroup::Motion:
      return code.number <= 30 || code.number == Modes::kNoMotion;
    case GGroup::Plane:
      return code.number == 170 && modes.plane.normal == 2;
    case GGroup::Distance:
    case GGroup::ArcDistance:
    case GGroup::Feed:
    case GGroup::Units:
    case GGroup::Return:
    case GGroup::Radius:
      return true;
    default:
      return false;
  }
}

/// Once it is off, until the tool is back on the program's own way: what goes by where the tool is.
bool may_be_behind(GGroup group, const Code& code) {
  if (group == GGroup::Once) return code.number == 40;
  return group != GGroup::System && group != GGroup::Turn && group != GGroup::Mirror &&
         (group != GGroup::Motion || code.number <= 30 || code.number == Modes::kNoMotion);
}

}  // namespace

double diameter_in_register(std::size_t place, const Options& options, const Modes& modes) {
  if (!modes.diameter_register) refuse(place, "no D says which offset holds the tool's radius; write D");
  const int number = *modes.diameter_register;
  if (number == 0) return 0;
  const auto found = options.tool_diameters_mm.find(number);
  if (found == options.tool_diameters_mm.end())
    refuse(place, fmt::format("what D{0} holds is not known here; give --tool-diameter {0}=MM, twice the radius that "
                              "the tool's centre is to be away",
                              number));
  return found->second;
}

void switch_compensation(Block& block, const Options& options, const Rules& rules, Modes& modes,
                         const Switches& switches, Mover& mover, Compensation& compensation) {
  if (const Word* word = rules.radius_is_offset ? block.find('D') : nullptr) set_register(*word, modes, compensation);
  const auto& code = block.g(GGroup::Radius);
  if (!code) return;
  if (code->number == 400) return compensation.end(code->place);
  if (compensation.on()) refuse(code->place, "cutter radius compensation is on already; write G40 before this");
  if (compensation.leaving()) refuse(code->place, "a straight move stands between G40 and this; write it");
  if (modes.plane.normal != 2) refuse(code->place, "cutter radius compensation is taken in G17");
  const double diameter = rules.radius_is_offset ? diameter_in_register(code->place, options, modes)
                                                 : diameter_of_tool(block, *code, options, modes, switches);
  const double radius = diameter / 2;
  compensation.begin(code->number < 420 ? radius : -radius, mover.start(code->place));
}

void require_only_moves(const Block& block, const Modes& modes, const Compensation& compensation) {
  if (!compensation.on() && !compensation.leaving()) return;
  for (std::size_t group = 0; group < kGGroups; ++group) {
    const auto kind = static_cast<GGroup>(group);
    const auto& code = block.g(kind);
    if (!code) continue;
    if (compensation.on() && !may_be_within(kind, *code, modes))
      refuse(code->place, "cutter radius compensation is on, and takes moves and feeds alone; write G40 before this");
    if (compensation.leaving() && !may_be_behind(kind, *code))
      refuse(code->place, "the tool is still beside the contour; write a straight move between G40 and this");
  }
  if (!compensation.on()) return;
  for (std::size_t group = 0; group < kMGroups; ++group) {
    const auto& code = block.m(static_cast<MGroup>(group));
    const bool ends = code && (code->number == 2 || code->number == 30 || code->number == 48);
    if (code && !ends)
      refuse(code->place, fmt::format("M{} while cutter radius compensation is on is not taken; write it before G41 or "
                                      "G42, or behind G40",
                                      code->number));
  }
  for (const char letter : {'S', 'T'}) {
    if (block.has(letter))
      refuse(block.place(letter), fmt::format("{} while cutter radius compensation is on is not taken; write it before "
                                              "G41 or G42, or behind G40",
                                              letter));
  }
}

}  // namespace rmac::gcode
