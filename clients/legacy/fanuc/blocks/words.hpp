#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "clients/legacy/fanuc/blocks/variables.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::fanuc {

/// A letter and its value.
struct FanucWord {
  char letter = '\0';
  gcode::Word word;
  bool vacant = false;    ///< then it counts as not written
  bool computed = false;  ///< its value is no number that is written
};

/// Reads the word that begins at `at`, and leaves `at` behind it. Throws a Refusal for what is none.
[[nodiscard]] FanucWord read_word(std::string_view text, std::size_t& at, const Variables& variables,
                                  const gcode::Modes& modes);

/// Steps over what may stand between words without a meaning, and the ; of a block's end.
void skip_comments(std::string_view text, std::size_t& at);
/// Throws a Refusal unless the line ends here.
void require_line_end(std::string_view text, std::size_t at);

/// The integer that a word has. Throws a Refusal where it is none from `least` to `most`.
[[nodiscard]] int integer_of(const gcode::Word& word, int least, int most, std::string_view meaning);

}  // namespace rmac::fanuc
