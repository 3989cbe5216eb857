#pragma once

#include <optional>

#include "clients/legacy/gcode/interpreter.hpp"
#include "clients/legacy/gcode/values/grammar.hpp"
#include "clients/legacy/rs274/flow/flow.hpp"

namespace rmac::rs274 {

/// What the control tells a program of itself by a number or a name, as far as the program's own words make it known.
[[nodiscard]] std::optional<double> told(const gcode::Interpreter& interpreter, const Flow& flow,
                                         const gcode::Name& name);

}  // namespace rmac::rs274
