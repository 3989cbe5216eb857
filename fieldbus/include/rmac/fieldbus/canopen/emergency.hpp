#pragma once

#include <cstdint>

namespace rmac::fieldbus::canopen {

/// What an emergency error code means (CiA 301, 7.2.7.1, table 26; drives' own ones: CiA 402-2, annex on error codes).
/// Also the meaning of a drive's object 603Fh. An unknown code is named by the class it is in.
[[nodiscard]] const char* emergency_text(std::uint16_t code) noexcept;

}  // namespace rmac::fieldbus::canopen
