#pragma once

#include <cstddef>
#include <cstdint>

namespace rmac::fieldbus {

/// Bits of a frame with an 11-bit identifier and `bytes` (0 to 8) of data on the wire, with as many stuff bits as
/// there can be, and the three bits between frames. ISO 11898-1: 34 bits before the end of the CRC beside the data can
/// be stuffed, one bit after the first five and then one after every four; 10 more and the interframe space cannot.
[[nodiscard]] constexpr std::uint32_t worst_frame_bits(std::size_t bytes) noexcept {
  constexpr std::uint32_t kStuffable = 34;
  constexpr std::uint32_t kUnstuffed = 10;
  constexpr std::uint32_t kInterframe = 3;
  const std::uint32_t stuffable = kStuffable + 8 * static_cast<std::uint32_t>(bytes);
  return stuffable + kUnstuffed + kInterframe + (stuffable - 1) / 4;
}

/// The same frame without a stuff bit: it cannot be shorter.
[[nodiscard]] constexpr std::uint32_t least_frame_bits(std::size_t bytes) noexcept {
  return 47 + 8 * static_cast<std::uint32_t>(bytes);
}

/// At most, of a frame whose identifier is known: the 19 bits before the data are stuffed as they are, and only the
/// data and the CRC are taken to be whatever is stuffed most.
[[nodiscard]] constexpr std::uint32_t worst_frame_bits(std::uint16_t id, std::size_t bytes) noexcept {
  constexpr unsigned kHeadBits = 19;
  constexpr std::uint32_t kCrcBits = 15, kRun = 5;
  // Start of frame 0, identifier, three bits 0 (a data frame, 11-bit identifiers, reserved), length.
  const std::uint32_t head = static_cast<std::uint32_t>(id) << 7U | static_cast<std::uint32_t>(bytes);
  std::uint32_t stuffed = 0, alike = 0;
  bool last = true;
  for (unsigned i = kHeadBits; i-- > 0;) {
    const bool bit = (head >> i & 1U) != 0;
    alike = bit == last ? alike + 1 : 1;
    last = bit;
    if (alike == kRun) {
      ++stuffed;
      last = !bit;
      alike = 1;
    }
  }
  const std::uint32_t rest = 8 * static_cast<std::uint32_t>(bytes) + kCrcBits;
  return least_frame_bits(bytes) + stuffed + (rest + alike - 1) / (kRun - 1);
}

}  // namespace rmac::fieldbus
