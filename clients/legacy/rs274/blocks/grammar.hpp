#pragma once

#include "clients/legacy/gcode/values/grammar.hpp"

namespace rmac::rs274 {

using gcode::Grammar, gcode::Operator, gcode::Function, gcode::Name, gcode::Maybe;

/// How RS274/NGC, as LinuxCNC has it, writes values.
[[nodiscard]] const Grammar& grammar() noexcept;

}  // namespace rmac::rs274
