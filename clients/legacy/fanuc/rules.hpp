#pragma once

#include "clients/legacy/gcode/modes/rules.hpp"

namespace rmac::fanuc {

/// What the words of blocks mean on a Fanuc.
[[nodiscard]] const gcode::Rules& rules() noexcept;

}  // namespace rmac::fanuc
