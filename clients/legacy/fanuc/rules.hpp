#pragma once

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "clients/legacy/gcode/modes/rules.hpp"

namespace rmac::fanuc {

/// What the words of blocks mean on such a control.
[[nodiscard]] const gcode::Rules& rules(Dialect dialect) noexcept;

}  // namespace rmac::fanuc
