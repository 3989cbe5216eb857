#pragma once

#include "clients/legacy/gcode/blocks/codes.hpp"

namespace rmac::rs274 {

/// Whether a G code by its tenfold ends what never begins here: of Mach and PathPilot, whose posts have it in headers.
[[nodiscard]] constexpr bool ends_nothing(int tenfold) noexcept {
  return tenfold == 150 || tenfold == 500 || tenfold == 690;
}

/// Null where RS274/NGC has none of this number.
[[nodiscard]] const gcode::GCode* find_g(int tenfold) noexcept;
[[nodiscard]] const gcode::MCode* find_m(int number) noexcept;

}  // namespace rmac::rs274
