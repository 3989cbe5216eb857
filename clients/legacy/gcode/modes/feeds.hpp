#pragma once

#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// G93, G94 and F of a block. `unit`: what the block changes it to, mm. No F of before is in force behind another code.
void set_feed(Block& block, const std::optional<double>& unit, const Rules& rules, Modes& modes);

}  // namespace rmac::gcode
