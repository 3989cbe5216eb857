#include "clients/legacy/fanuc/work_systems.hpp"

#include <fmt/format.h>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/blocks/words.hpp"
#include "clients/legacy/gcode/modes/offsets.hpp"

namespace rmac::fanuc {

namespace {

constexpr int kPlain = 6, kFurther = 300;

void set_system(gcode::Block& block, const gcode::Modes& modes, gcode::Coordinates& coordinates, std::size_t place) {
  constexpr int kOfPlain = 2, kOfFurther = 20;
  const gcode::Word* kind = block.find('L');
  if (kind == nullptr || (kind->value != kOfPlain && kind->value != kOfFurther))
    refuse(kind != nullptr ? kind->place : place,
           "of G10 there are L2 and L20, which set work systems; tools are set by rmac tools");
  if (!block.has('P')) refuse(place, "G10 needs P, the work system");
  const gcode::Word& which = block.use('P');
  const bool further = kind->value == kOfFurther;
  if (!further && which.value == 0)
    refuse(which.place, "the offset of all work systems (P0) is not taken; set each of them");
  const int number = integer_of(which, 1, further ? kFurther : kPlain, "P of G10 is the work system");
  const auto system = static_cast<std::size_t>(number - 1 + (further ? kPlain : 0));
  gcode::Known offset = coordinates.offset(system);
  for (std::size_t axis = 0; axis < offset.size(); ++axis) {
    const gcode::Word* word = block.find(gcode::kAxisLetters.at(axis));
    if (word == nullptr) continue;
    if (modes.incremental && !offset.at(axis))
      refuse(word->place, "what this is added to (G91) is not known here; write G90 before it, or give --offset");
    offset.at(axis) = modes.mm(*word) + (modes.incremental ? *offset.at(axis) : 0);
  }
  if (system == coordinates.active() && !(offset[0] && offset[1] && offset[2])) {
    const std::string name = system_name(system).name;
    refuse(place, fmt::format("of {0}, which is in force, only a part is set and the rest is not known; write X, Y and "
                              "Z, or give --offset {0}=X,Y,Z",
                              name));
  }
  coordinates.set_offset(system, offset);
}

/// G52, whose values are absolute in the work system.
void set_local(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
               gcode::Coordinates& coordinates) {
  if (!block.has_any("XYZ")) refuse(code.place, "G52 needs X, Y or Z");
  if (modes.incremental) refuse(code.place, "G52 under G91; write G90 before it");
  gcode::Point local = coordinates.local();
  for (std::size_t axis = 0; axis < local.size(); ++axis) {
    if (const gcode::Word* word = block.find(gcode::kAxisLetters.at(axis))) local.at(axis) = modes.mm(*word);
  }
  coordinates.set_local(local);
}

/// G92 sets what the coordinates are where the tool is, and ends G52; G92.1 takes both away.
void shift(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes, gcode::Coordinates& coordinates) {
  constexpr int kSet = 920;
  const bool sets = code.number == kSet;
  if (!block.has_any("XYZ")) refuse(code.place, fmt::format("{} needs X, Y or Z", gcode::g_name(code.number)));
  gcode::Point local = coordinates.local(), shift{coordinates.g92(0), coordinates.g92(1), coordinates.g92(2)};
  for (std::size_t axis = 0; axis < shift.size(); ++axis) {
    const char letter = gcode::kAxisLetters.at(axis);
    if (!block.has(letter)) continue;
    const gcode::Word word = block.take(letter);
    if (!sets && word.value != 0) refuse(word.place, "X, Y and Z of G92.1 are 0: the axes that it is for");
    local.at(axis) = 0;
    shift.at(axis) = sets ? gcode::known_or_refuse(coordinates.tip().at(axis), word) - modes.mm(word) : 0;
  }
  coordinates.set_local(local);
  coordinates.set_g92(shift);
}

}  // namespace

std::size_t system_of(gcode::Block& block, const gcode::Code& code) {
  constexpr int kFirst = 540, kFurtherCode = 541, kFirstCycle = 730, kFirstOfHaas = 1100, kFurtherOfHaas = 1540;
  constexpr int kMostOfHaas = 99;
  const bool of_haas = code.number == kFurtherOfHaas;
  if (code.number >= kFirstOfHaas && !of_haas)
    return static_cast<std::size_t>((code.number - kFirstOfHaas) / 10 + kPlain);
  const auto& motion = block.g(gcode::GGroup::Motion);
  const bool has_other_p = block.once(40) || block.once(100) || (motion && motion->number >= kFirstCycle);
  const bool is_further =
      of_haas || code.number == kFurtherCode || (code.number == kFirst && block.has('P') && !has_other_p);
  if (!is_further) return static_cast<std::size_t>(code.number / 10 - kFirst / 10);
  if (!block.has('P') || has_other_p)
    refuse(code.place, fmt::format("{} needs P, the number of the work system, and a block without another P",
                                   of_haas ? "G154" : "G54.1"));
  const int number = integer_of(block.use('P'), 1, of_haas ? kMostOfHaas : kFurther, "P of this is a work system");
  return static_cast<std::size_t>(number - 1 + kPlain);
}

gcode::SystemName system_name(std::size_t system) {
  constexpr std::size_t kFirst = 54;
  if (system < kPlain) return {fmt::format("G{}", kFirst + system), fmt::format("G10 L2 P{}", system + 1)};
  const std::size_t further = system - kPlain + 1;
  return {fmt::format("G54.1P{}", further), fmt::format("G10 L20 P{}", further)};
}

gcode::SystemName haas_system_name(std::size_t system) {
  if (system < kPlain) return system_name(system);
  const std::size_t further = system - kPlain + 1;
  return {fmt::format("G154P{}", further), fmt::format("G10 L20 P{}", further)};
}

void set_coordinates(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
                     gcode::Coordinates& coordinates) {
  constexpr int kOffsets = 100, kLocal = 520;
  if (code.number == kOffsets) return set_system(block, modes, coordinates, code.place);
  if (code.number == kLocal) return set_local(block, code, modes, coordinates);
  shift(block, code, modes, coordinates);
}

}  // namespace rmac::fanuc
