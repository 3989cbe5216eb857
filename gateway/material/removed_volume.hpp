#pragma once

#include <array>

#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/removal.hpp"

namespace rmac::gateway {

/// How much was removed, and how far the families of rays differ in it.
struct RemovedVolume {
  double mm3 = 0, spread_mm3 = 0;
};

/// Sums up what cuts removed. A family sees a thin layer that lies along its rays in whole cells or not at all; it
/// counts by the square of how large what was removed looks along it.
class RemovedSum {
 public:
  explicit RemovedSum(double stock_mm3) noexcept : stock_mm3_(stock_mm3) {}
  void add(const Removal& removal) noexcept;
  /// `grid`: of the cuts.
  [[nodiscard]] RemovedVolume estimate(const DexelGrid& grid) const;
  [[nodiscard]] double left_mm3(const DexelGrid& grid) const { return stock_mm3_ - estimate(grid).mm3; }

 private:
  double stock_mm3_;                   ///< before anything was cut
  std::array<double, 3> by_family_{};  ///< mm³
};

}  // namespace rmac::gateway
