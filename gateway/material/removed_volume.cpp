#include "gateway/material/removed_volume.hpp"

#include <cmath>

namespace rmac::gateway {

void RemovedSum::add(const Removal& removal) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) by_family_[axis] += removal.volumes_mm3[axis];
}

RemovedVolume RemovedSum::estimate(const DexelGrid& grid) const {
  std::array<double, 3> weights{};
  double sum = 0;
  RemovedVolume volume;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    weights[axis] = std::pow(grid.touched_area_mm2(axis), 2);
    sum += weights[axis];
    volume.mm3 += weights[axis] * by_family_[axis];
  }
  if (sum == 0) return {};
  volume.mm3 /= sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    volume.spread_mm3 += weights[axis] / sum * std::pow(by_family_[axis] - volume.mm3, 2);
  }
  volume.spread_mm3 = std::sqrt(volume.spread_mm3);
  return volume;
}

}  // namespace rmac::gateway
