#include "gateway/material/dexel_layout.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

/// Cells along an extent; one that is a multiple of the resolution has no cell more for its last digit.
double cells(double extent_mm, double resolution_mm) {
  constexpr double kRounding = 1e-9;
  return std::max(1.0, std::ceil(extent_mm / resolution_mm - kRounding));
}

}  // namespace

DexelLayout DexelLayout::of(const Eigen::AlignedBox3d& box, double resolution_mm) {
  DexelLayout layout;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto i = static_cast<Eigen::Index>(a);
    const double extent = box.sizes()[i], n = cells(extent, resolution_mm);
    layout.low[a] = box.min()[i];
    layout.count[a] = static_cast<std::uint32_t>(n);
    layout.pitch[a] = extent / n;
  }
  return layout;
}

double dexel_bytes(const Eigen::AlignedBox3d& box, double resolution_mm) {
  const Eigen::Vector3d size = box.sizes();
  const double x = cells(size[0], resolution_mm), y = cells(size[1], resolution_mm), z = cells(size[2], resolution_mm);
  return static_cast<double>(DexelLayout::kBytesOfRay) * (x * y + y * z + z * x);
}

double finest_resolution(const Eigen::AlignedBox3d& box, double bytes) {
  constexpr std::array kSteps{1.0, 2.0, 5.0};
  constexpr int kFinest = -4, kCoarsest = 5;
  for (int power = kFinest; power < kCoarsest; ++power) {
    for (const double step : kSteps) {
      const double resolution = step * std::pow(10.0, power);
      if (dexel_bytes(box, resolution) <= bytes) return resolution;
    }
  }
  return std::pow(10.0, kCoarsest);
}

}  // namespace rmac::gateway
