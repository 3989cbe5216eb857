#pragma once

#include <optional>

#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/stock.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

inline constexpr double kMostMaterialBytes = 2e9;
/// Where no resolution is given: the finest of 1, 2 or 5 times a power of ten that takes at most this.
inline constexpr double kUsualMaterialBytes = 64e6;

/// The stock as rays of this resolution see it. Refused, before anything is taken, where it would need more memory than
/// there may be, with the resolution that would not; and where no ray meets it.
[[nodiscard]] Expected<DexelGrid> model_of(const Stock& stock, std::optional<double> resolution_mm);

}  // namespace rmac::gateway
