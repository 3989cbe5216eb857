#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace rmac::gateway {

/// Of a name that a client gives, where it is told.
inline constexpr std::size_t kLongestName = 64;

/// A text that somebody else wrote, for a log, a terminal, or a JSON text: one line of valid UTF-8, of at most
/// `longest` bytes. Control characters and bytes that are no UTF-8 become '?'; a character that would be cut in its
/// midst is left out.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

/// JSON as it goes to somebody else, in one line. Bytes of its texts that are no UTF-8 (a file's, an operating
/// system's) go as U+FFFD.
[[nodiscard]] std::string text_of(const nlohmann::json& json);

}  // namespace rmac::gateway
