#pragma once

#include "clients/legacy/gcode/values/grammar.hpp"

namespace rmac::fanuc {

using gcode::Grammar, gcode::Maybe;

/// How custom macro B writes values. Angles are those of a control as it is delivered: ATAN[y]/[x] is 0 to 360 degrees,
/// ASIN 270 to 360 and 0 to 90.
[[nodiscard]] const Grammar& grammar() noexcept;
/// The same in a word, where ROUND rounds to the digits that a control has there: 0.001 mm or 0.0001 inch.
[[nodiscard]] const Grammar& grammar_of_words(bool inch) noexcept;

/// Of what is read and not computed: all values are 1.
[[nodiscard]] const Grammar& grammar_of_syntax() noexcept;

}  // namespace rmac::fanuc
