#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "clients/legacy/fanuc/blocks/codes.hpp"
#include "clients/legacy/gcode/blocks/block.hpp"

namespace rmac::fanuc {

/// Which of the controls that read such programs one is for.
enum class Dialect { Fanuc, Haas };

/// What a Haas means by an M code that elsewhere is a builder's.
struct HaasM {
  enum class Use {
    Nothing,    ///< the cut does not depend on it, or the appliance does it itself
    SwitchOn,   ///< it switches on what --output names, by its own number
    SwitchOff,  ///< it switches that off: `as` is the number that switches it on
    As,         ///< the same as M and `as`
    Refused
  };
  int number = 0;
  Use use = Use::Nothing;
  int as = 0;
  std::string_view message;  ///< why it is refused, or what it switches
};

/// Null where a Haas has nothing of its own of this number.
[[nodiscard]] const HaasM* find_haas_m(int number) noexcept;
[[nodiscard]] const FanucG* find_haas_g(int tenfold) noexcept;

/// What of a block is a Haas' own, and carried out around the rest of it.
struct HaasWords {
  struct Switched {
    int number = 0;  ///< of the code that switches it on
    bool on = false;
    std::string_view what;
    std::size_t place = 0;
  };
  std::optional<gcode::Code> cycle;  ///< G12, G13, G70 or G71
  std::vector<Switched> switched;
};

}  // namespace rmac::fanuc
