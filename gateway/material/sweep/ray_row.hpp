#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace rmac::gateway {

/// Lines side by side, as rays lie in a tile: one coordinate across them is the same.
struct RayRow {
  static constexpr std::size_t kRays = 8;
  std::array<double, kRays> first{};
  double second = 0;
};

/// What a solid has of each of them; `from` > `to`: nothing.
struct RowMet {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  std::array<double, RayRow::kRays> from{}, to{};

  void none(std::size_t ray) noexcept { from[ray] = kNever, to[ray] = -kNever; }
  void none() noexcept { from.fill(kNever), to.fill(-kNever); }
};

/// Line by line, for what has no faster way.
template <class Lines>
void meet_one_by_one(const Lines& lines, const RayRow& row, RowMet& met) noexcept {
  for (std::size_t i = 0; i < RayRow::kRays; ++i) {
    if (!lines(row.first[i], row.second, met.from[i], met.to[i])) met.none(i);
  }
}

}  // namespace rmac::gateway
