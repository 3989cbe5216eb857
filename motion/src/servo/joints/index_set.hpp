#pragma once

#include <cstddef>
#include <cstdint>

namespace rmac {

/// A set of joints, or of actuators, by their numbers: bit i is number i.
using IndexSet = std::uint32_t;

[[nodiscard]] constexpr IndexSet only(std::size_t index) noexcept {
  return IndexSet{1} << index;
}
/// Numbers 0 to `count` - 1.
[[nodiscard]] constexpr IndexSet first(std::size_t count) noexcept {
  return static_cast<IndexSet>((std::uint64_t{1} << count) - 1);
}
[[nodiscard]] constexpr bool has(IndexSet set, std::size_t index) noexcept {
  return (set >> index & 1U) != 0;
}

}  // namespace rmac
