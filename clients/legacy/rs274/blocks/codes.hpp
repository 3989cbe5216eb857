#pragma once

#include "clients/legacy/gcode/blocks/codes.hpp"

namespace rmac::rs274 {

/// Null where RS274/NGC has none of this number.
[[nodiscard]] const gcode::GCode* find_g(int tenfold) noexcept;
[[nodiscard]] const gcode::MCode* find_m(int number) noexcept;

}  // namespace rmac::rs274
