#pragma once

#include <string_view>

#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::fieldbus::eds {

/// A whole number as CiA 306 writes it: decimal, hexadecimal behind 0x, octal behind 0. Nothing when it is none, or
/// does not fit 64 bits.
struct Whole {
  bool negative = false;
  std::uint64_t magnitude = 0;
};
[[nodiscard]] std::optional<Whole> read_whole(std::string_view text) noexcept;
/// One that is not negative and at most `most`.
[[nodiscard]] std::optional<std::uint64_t> read_count(std::string_view text, std::uint64_t most) noexcept;

/// A value of `type`. Nothing when the text is none, or the number does not fit. A domain's value is a file's name in
/// the standard; it is taken for none, and so are the maker's own types.
[[nodiscard]] std::optional<Value> read_value(std::string_view text, DataType type);

}  // namespace rmac::fieldbus::eds
