#pragma once

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// M62 to M65, which switch an output, and M66, which waits for an input. A program has numbers for them and the
/// machine names; whoever imports the program says which is which.
void act_on_names(Block& block, const Options& options, Writer& writer);

}  // namespace rmac::gcode
