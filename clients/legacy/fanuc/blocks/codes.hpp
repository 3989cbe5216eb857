#pragma once

#include "clients/legacy/gcode/blocks/codes.hpp"

namespace rmac::fanuc {

/// What becomes of a code before its block is carried out.
enum class Use {
  Block,      ///< the block has it
  Nothing,    ///< so it is, or it ends what never begins here
  LookAhead,  ///< passed over with its words
  HaasCycle,  ///< written out as other blocks
  PolarOn,    ///< X and Y are a distance and an angle from it on
  PolarOff,
  EndOfModalCall
};

struct FanucG {
  gcode::GCode code;
  Use use = Use::Block;
};

/// Null where there is none of this number.
[[nodiscard]] const FanucG* find_g(int tenfold) noexcept;
[[nodiscard]] const gcode::MCode* find_m(int number) noexcept;

}  // namespace rmac::fanuc
