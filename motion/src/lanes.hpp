#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace rmac {

/// Numbers that are worked on at once: as many as every processor of the platform has room for in a register. Wider
/// ones would have to be compiled for newer processors apart.
inline constexpr std::size_t kLanes = 2;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneMask = decltype(Lanes{} == Lanes{});
using LaneTriple = std::array<Lanes, 3>;

[[nodiscard]] [[gnu::always_inline]] inline Lanes all_lanes(double value) noexcept {
  return Lanes{value, value};
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes load(const double* from) noexcept {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
[[gnu::always_inline]] inline void store(Lanes lanes, double* to) noexcept {
  std::memcpy(to, &lanes, sizeof lanes);
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes larger(Lanes a, Lanes b) noexcept {
  return a > b ? a : b;
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes smaller(Lanes a, Lanes b) noexcept {
  return a < b ? a : b;
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes square_root(Lanes a) noexcept {
  return Lanes{std::sqrt(a[0]), std::sqrt(a[1])};
}
[[nodiscard]] [[gnu::always_inline]] inline double sum(Lanes a) noexcept {
  return a[0] + a[1];
}
[[nodiscard]] [[gnu::always_inline]] inline double largest(Lanes a) noexcept {
  return std::max(a[0], a[1]);
}
[[nodiscard]] [[gnu::always_inline]] inline double smallest(Lanes a) noexcept {
  return std::min(a[0], a[1]);
}
/// Three neighbouring numbers, each in all lanes.
[[nodiscard]] [[gnu::always_inline]] inline LaneTriple lanes_of(const double* first) noexcept {
  return {all_lanes(first[0]), all_lanes(first[1]), all_lanes(first[2])};
}
[[nodiscard]] [[gnu::always_inline]] inline Lanes dot(const LaneTriple& a, const LaneTriple& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace rmac
