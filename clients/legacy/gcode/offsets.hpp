#pragma once

#include "clients/legacy/gcode/modes.hpp"

namespace rmac::gcode {

// What changes the meaning of coordinates. Each takes its words of the block, and refuses what is not known.

/// G54 to G59.3.
void select_system(const Code& code, Coordinates& coordinates);
/// G10 L2 and L20.
void set_system(Block& block, const Modes& modes, Coordinates& coordinates, std::size_t place);
/// G92 to G92.3.
void shift_coordinates(Block& block, const Code& code, const Modes& modes, Coordinates& coordinates);

}  // namespace rmac::gcode
