#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::rs274 {

/// G54 to G59.3.
[[nodiscard]] std::size_t system_of(gcode::Block& block, const gcode::Code& code);
[[nodiscard]] gcode::SystemName system_name(std::size_t system);
/// G10 L2 and L20, G52, G92 to G92.3. Each takes its words of the block, and refuses what is not known.
void set_coordinates(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
                     gcode::Coordinates& coordinates);

}  // namespace rmac::rs274
