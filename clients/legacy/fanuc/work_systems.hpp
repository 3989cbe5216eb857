#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::fanuc {

/// G54 to G59, and G54.1 P1 to P300 behind them; a Haas has G154 P1 to P99 there, and G110 to G129 for the first.
[[nodiscard]] std::size_t system_of(gcode::Block& block, const gcode::Code& code);
[[nodiscard]] gcode::SystemName system_name(std::size_t system);
[[nodiscard]] gcode::SystemName haas_system_name(std::size_t system);
/// G10 L2 and L20, G52, G92 and G92.1. Each takes its words of the block, and refuses what is not known.
void set_coordinates(gcode::Block& block, const gcode::Code& code, const gcode::Modes& modes,
                     gcode::Coordinates& coordinates);

}  // namespace rmac::fanuc
