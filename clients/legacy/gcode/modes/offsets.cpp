#include "clients/legacy/gcode/modes/offsets.hpp"

#include <fmt/format.h>

namespace rmac::gcode {

double known_or_refuse(const std::optional<double>& value, const Word& word) {
  if (!value)
    refuse(word.place,
           "where the tool is now is not known, so neither is what this sets; write a G0 to X, Y and Z before it");
  return *value;
}

void require_unplaced(const Coordinates& coordinates, std::size_t place) {
  if (coordinates.placement())
    refuse(place, "this in turned, tilted or mirrored coordinates is not taken; write G69, or G50.1, before it");
}

void select_system(Block& block, const Code& code, const Rules& rules, Coordinates& coordinates) {
  const std::size_t system = rules.system_of(block, code);
  if (system == coordinates.active()) return;
  activate_system(system, code.place, rules, coordinates);
}

void activate_system(std::size_t system, std::size_t place, const Rules& rules, Coordinates& coordinates) {
  require_unplaced(coordinates, place);
  for (const std::size_t needed : {system, coordinates.active()}) {
    const Known& offset = coordinates.offset(needed);
    if (offset[0] && offset[1] && offset[2]) continue;
    const SystemName name = rules.system_name(needed);
    refuse(place, fmt::format("where {0} is in the machine is not known here; set it by {1} X Y Z before, or give "
                              "--offset {0}=X,Y,Z",
                              name.name, name.setter));
  }
  coordinates.activate(system);
}

}  // namespace rmac::gcode
