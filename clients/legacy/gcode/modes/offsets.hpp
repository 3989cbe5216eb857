#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// A code of the group System. Refused where it is not known where the systems are in the machine.
void select_system(Block& block, const Code& code, const Rules& rules, Coordinates& coordinates);

/// The same of a system by its index that is not in force.
void activate_system(std::size_t system, std::size_t place, const Rules& rules, Coordinates& coordinates);

/// Throws a Refusal where coordinates are turned, tilted or mirrored.
void require_unplaced(const Coordinates& coordinates, std::size_t place);

/// A place of the tool that a word sets something by. Throws a Refusal where it is not known.
[[nodiscard]] double known_or_refuse(const std::optional<double>& value, const Word& word);

}  // namespace rmac::gcode
