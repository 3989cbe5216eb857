#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"
#include "clients/legacy/gcode/switches.hpp"

namespace rmac::gcode {

/// G40, G41, G42, G41.1 and G42.1 of a block, with D.
void switch_compensation(Block& block, const Options& options, const Rules& rules, Modes& modes,
                         const Switches& switches, Mover& mover, Compensation& compensation);

/// In mm, of the offset that the last D named. Throws a Refusal where nothing says it.
[[nodiscard]] double diameter_in_register(std::size_t place, const Options& options, const Modes& modes);

/// Refuses what would have to be done between moves that are held back, or whose place is another than the tool's.
void require_only_moves(const Block& block, const Modes& modes, const Compensation& compensation);

}  // namespace rmac::gcode
