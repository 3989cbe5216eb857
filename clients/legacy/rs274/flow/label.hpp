#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "clients/legacy/rs274/blocks/parameters.hpp"

namespace rmac::rs274 {

/// What stands behind an O: a number, a <name>, or a value that is computed.
struct Label {
  std::string text;       ///< digits, the name in capitals, or the value's text
  bool computed = false;  ///< the latter, where parameters decide it
};

/// Reads a label, and leaves `at` behind it. Throws a Refusal for what is none.
[[nodiscard]] Label read_label(std::string_view text, std::size_t& at);

/// The label that the value at `at` has now, as digits. Throws a Refusal where it is no number of a label.
[[nodiscard]] std::string computed_label(std::string_view text, std::size_t at, const Parameters& parameters);

}  // namespace rmac::rs274
