#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rmac/fieldbus/eds/object_entry.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::eds {

/// What the bytes of an object mean. Text holds printable ASCII alone: other characters are written as \x07, trailing
/// zeros are left out.
using TypedValue = std::variant<bool, std::int64_t, std::uint64_t, double, std::string>;

/// A value of `type` from the bytes that an SDO or a PDO carried. Bytes that are too few or too many for the type, and
/// those of a type of free length, are text in hexadecimal: "01 02".
[[nodiscard]] TypedValue value_of(std::span<const std::uint8_t> bytes, DataType type);

/// A value of an unknown type: a number without sign where it has 1, 2, 4 or 8 bytes; text where all of it is
/// printable; hexadecimal text otherwise.
[[nodiscard]] TypedValue value_of(std::span<const std::uint8_t> bytes);

/// As a person reads it.
[[nodiscard]] std::string to_text(const TypedValue& value);

/// The bytes of what a person wrote: whole numbers decimal or hexadecimal (0x1F, 1Fh), reals with a point, octets and
/// domains as hexadecimal pairs. A leading zero means nothing, unlike in an EDS. Refuses what the type does not hold,
/// and says what it does; only hexadecimal digits may fill a signed type's width (0xFF is -1).
[[nodiscard]] Expected<std::vector<std::uint8_t>> bytes_of_text(std::string_view text, DataType type);

}  // namespace rmac::fieldbus::eds
