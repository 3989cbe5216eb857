#pragma once

#include <cstdint>
#include <span>

#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::fieldbus::canopen {

/// Abort codes that this side sends or reacts to (CiA 301, 7.2.4.3.17, table 22).
namespace sdo_abort {
inline constexpr std::uint32_t kToggle = 0x05030000;
inline constexpr std::uint32_t kTimeout = 0x05040000;
inline constexpr std::uint32_t kCommand = 0x05040001;
inline constexpr std::uint32_t kBlockSize = 0x05040002;
inline constexpr std::uint32_t kSequence = 0x05040003;
inline constexpr std::uint32_t kCrc = 0x05040004;
inline constexpr std::uint32_t kMemory = 0x05040005;
inline constexpr std::uint32_t kNoObject = 0x06020000;
inline constexpr std::uint32_t kLength = 0x06070010;
inline constexpr std::uint32_t kNoSubindex = 0x06090011;
inline constexpr std::uint32_t kNoResource = 0x060A0023;
inline constexpr std::uint32_t kGeneral = 0x08000000;
inline constexpr std::uint32_t kPresentState = 0x08000022;
}  // namespace sdo_abort

/// What an abort code means, in the standard's words; codes of the maker's own are named as such.
[[nodiscard]] const char* sdo_abort_text(std::uint32_t code) noexcept;

/// The checksum of block transfers: polynomial x^16 + x^12 + x^5 + 1, beginning with 0 (CiA 301, 7.2.4.3.16).
/// `so_far` continues one.
[[nodiscard]] std::uint16_t sdo_crc(std::span<const std::uint8_t> bytes, std::uint16_t so_far = 0) noexcept;

/// Little-endian numbers, as everything on CANopen.
inline void put_word(std::uint8_t* at, std::uint16_t value) noexcept {
  at[0] = static_cast<std::uint8_t>(value);
  at[1] = static_cast<std::uint8_t>(value >> 8);
}
inline void put_long(std::uint8_t* at, std::uint32_t value) noexcept {
  for (unsigned i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}
[[nodiscard]] inline std::uint16_t word_at(const std::uint8_t* at) noexcept {
  return static_cast<std::uint16_t>(at[0] | at[1] << 8);
}
[[nodiscard]] inline std::uint32_t long_at(const std::uint8_t* at) noexcept {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8 * i);
  return value;
}

}  // namespace rmac::fieldbus::canopen
