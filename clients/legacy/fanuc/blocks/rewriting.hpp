#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::fanuc {

// Words of a block that other languages write otherwise, as those write them.

/// X and U of G4, which are seconds, become P.
void rewrite_dwell(gcode::Block& block, const gcode::Modes& modes);
/// U, V and W of G28 and G30 become ways along X, Y and Z. `all_alone`: G28 without axes takes all of them there.
void rewrite_reference(gcode::Block& block, bool all_alone);
/// Under G16 X and Y of a move or a hole become the distance from zero and the angle.
void rewrite_polar(gcode::Block& block, const gcode::Modes& modes);
/// Takes away the words of G5, G5.1, G8, G103 and G187, which say how far a control looks ahead and how it rounds
/// corners: the appliance does both itself. Throws a Refusal where they may mean more.
void pass_over_look_ahead(gcode::Block& block, const gcode::Code& code);

}  // namespace rmac::fanuc
