#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rmac::gateway {

/// A text that somebody else wrote, for a log, a terminal, or a JSON text: one line of valid UTF-8, of at most
/// `longest` bytes. Control characters and bytes that are no UTF-8 become '?'; a character that would be cut in its
/// midst is left out.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

}  // namespace rmac::gateway
