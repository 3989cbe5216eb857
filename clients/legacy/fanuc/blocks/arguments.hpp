#pragma once

#include <string_view>

#include "clients/legacy/fanuc/blocks/words.hpp"

namespace rmac::fanuc {

/// G65 and G66: a macro, how often, and what it has in its own variables.
struct MacroCall {
  int program = 0, times = 1;
  Variables::Locals locals{};
  std::size_t place = 0;
};

/// Reads the words behind G65 or G66, from `at` to the line's end: A to Z but G, L, N, O and P (argument specification
/// I), and I, J, K again and again (II). Of two words for one variable the later one counts. Throws a Refusal.
[[nodiscard]] MacroCall read_macro_call(std::string_view text, std::size_t at, const Variables& variables,
                                        const gcode::Modes& modes);

}  // namespace rmac::fanuc
