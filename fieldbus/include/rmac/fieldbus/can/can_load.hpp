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

}  // namespace rmac::fieldbus
