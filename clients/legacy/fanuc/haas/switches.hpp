#pragma once

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::fanuc::haas {

/// M73, M83 and M88 of a block, which switch on what an option gives a name of the machine's outputs: before its
/// motion. Throws a Refusal where nothing says which output that is, or the block itself would switch it off.
void switch_on(const HaasWords& words, const gcode::Block& block, const gcode::Options& options,
               gcode::Interpreter& interpreter);
/// M74, M84 and M89: behind that.
void switch_off(const HaasWords& words, const gcode::Options& options, gcode::Interpreter& interpreter);

}  // namespace rmac::fanuc::haas
