#pragma once

#include <array>
#include <optional>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// Where the tool is in the program's own coordinates and unit, X and Y; none where that is not known.
using ProgramTip = std::array<std::optional<double>, 2>;

/// Likewise, where @ and ^ of a block lead from there. What of the two is not written stays as the tool has it; under
/// G91 both go on from where that is. Throws a Refusal.
using PolarEnd = std::array<double, 2>;
[[nodiscard]] PolarEnd polar_end(const Block& block, const Modes& modes, const ProgramTip& tip);

/// @ and ^ of a block, as LinuxCNC has them, become its X and Y: the distance from zero and the angle from X, in
/// degrees. Throws a Refusal.
void place_polar(Block& block, const Modes& modes, const ProgramTip& tip);

}  // namespace rmac::gcode
