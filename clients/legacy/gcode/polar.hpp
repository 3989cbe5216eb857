#pragma once

#include <array>
#include <optional>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// Where the tool is in the program's own coordinates and unit, X and Y; none where that is not known.
using ProgramTip = std::array<std::optional<double>, 2>;

/// @ and ^ of a block, as LinuxCNC has them, become its X and Y: the distance from zero and the angle from X, in
/// degrees. What of the two is not written stays as the tool has it; under G91 both go on from where that is. Throws a
/// Refusal.
void place_polar(Block& block, const Modes& modes, const ProgramTip& tip);

}  // namespace rmac::gcode
