#include "clients/legacy/rs274/work_systems.hpp"

#include <fmt/format.h>

#include <cmath>

#include "clients/legacy/gcode/modes/offsets.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

constexpr std::size_t kSystems = 9;

std::size_t system_of(const gcode::Word& word, const gcode::Coordinates& coordinates) {
  if (word.value != std::round(word.value) || word.value < 0 || word.value > kSystems) {
    refuse(word.place, "P of G10 is the work system: 1 is G54, 6 is G59, 9 is G59.3, 0 the one in force");
  }
  return word.value == 0 ? coordinates.active() : static_cast<std::size_t>(word.value) - 1;
}

void set_system(gcode::Block& block, const gcode::Modes& modes, gcode::Coordinates& coordinates, std::size_t place) {
  const gcode::Word* kind = block.find('L');
  if (kind == nullptr || (kind->value != 2 && kind->value != 20)) {
    refuse(kind != nullptr ? kind->place : place,
           "of G10 there are L2 and L20, which set work systems; tools are set by rmac tools");
  }
  if (!block.has('P')) refuse(place, "G10 needs P, the work system");
  if (block.has('R')) refuse(block.use('R').place, "a work system that is turned (R) is not taken yet");
  const std::size_t system = system_of(block.use('P'), coordinates);
  gcode::Known offset = coordinates.offset(system);
  for (std::size_t axis = 0; axis < offset.size(); ++axis) {
    const gcode::Word* word = block.find(gcode::kAxisLetters.at(axis));
    if (word == nullptr) continue;
    offset.at(axis) = modes.mm(*word);
    if (kind->value == 20) {
      const double machine = gcode::known_or_refuse(coordinates.machine_tip(axis), *word);
      offset.at(axis) = machine - modes.mm(*word) - coordinates.g92(axis);
    }
  }
  if (system == coordinates.active() && !(offset[0] && offset[1] && offset[2])) {
    refuse(place, fmt::format("of {}, which is in force, only a part is set and the rest is not known; write X, Y and "
                              "Z, or give --offset {}=X,Y,Z",
                              system_name(system).name, system_name(system).name));
  }
  coordinates.set_offset(system, offset);
}

void shift_coordinates(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
                       gcode::Coordinates& coordinates) {
  if (code.number == 921) return coordinates.set_g92({});
  if (code.number == 922) return coordinates.suspend_g92();
  if (code.number == 923) return coordinates.restore_g92();
  if (!block.has_any("XYZ")) refuse(code.place, "G92 needs X, Y or Z");
  gcode::Point shift{coordinates.g92(0), coordinates.g92(1), coordinates.g92(2)};
  for (std::size_t axis = 0; axis < shift.size(); ++axis) {
    const gcode::Word* word = block.find(gcode::kAxisLetters.at(axis));
    if (word != nullptr) shift.at(axis) = gcode::known_or_refuse(coordinates.tip().at(axis), *word) - modes.mm(*word);
  }
  coordinates.set_g92(shift);
}

/// G52 writes what G92 keeps, as LinuxCNC has it: absolute, under G91 too, and each axis in the place of what it had.
void set_local(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
               gcode::Coordinates& coordinates) {
  if (!block.has_any("XYZ")) refuse(code.place, "G52 needs X, Y or Z");
  gcode::Point shift{coordinates.g92(0), coordinates.g92(1), coordinates.g92(2)};
  for (std::size_t axis = 0; axis < shift.size(); ++axis) {
    if (const gcode::Word* word = block.find(gcode::kAxisLetters.at(axis))) shift.at(axis) = modes.mm(*word);
  }
  coordinates.set_g92(shift);
}

}  // namespace

std::size_t system_of(gcode::Block&, const gcode::Code& code) {
  return static_cast<std::size_t>(code.number >= 591 ? code.number - 585 : code.number / 10 - 54);
}

gcode::SystemName system_name(std::size_t system) {
  return {system < 6 ? fmt::format("G{}", 54 + system) : fmt::format("G59.{}", system - 5),
          fmt::format("G10 L2 P{}", system + 1)};
}

void set_coordinates(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
                     gcode::Coordinates& coordinates) {
  constexpr int kOffsets = 100, kLocal = 520;
  if (code.number == kOffsets) return set_system(block, modes, coordinates, code.place);
  if (code.number == kLocal) return set_local(block, code, modes, coordinates);
  shift_coordinates(block, code, modes, coordinates);
}

}  // namespace rmac::rs274
