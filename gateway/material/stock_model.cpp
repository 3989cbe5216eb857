#include "gateway/material/stock_model.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rmac::gateway {

Expected<DexelGrid> model_of(const Stock& stock, std::optional<double> resolution_mm) {
  const Eigen::AlignedBox3d& box = stock.bounds();
  const double resolution = resolution_mm.value_or(finest_resolution(box, kUsualMaterialBytes));
  if (!(resolution > 0) || !std::isfinite(resolution)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("a resolution of {} mm is none; give one above 0, in mm", resolution));
  }
  const Eigen::Vector3d size = box.sizes();
  constexpr double kGigabyte = 1e9;
  if (const double bytes = dexel_bytes(box, resolution); !(bytes <= kMostMaterialBytes)) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("a resolution of {} mm takes {:.3g} GB of memory for a stock of {:.4g} x {:.4g} x {:.4g} "
                    "mm; {} mm takes less than {:.0f} GB",
                    resolution, bytes / kGigabyte, size[0], size[1], size[2],
                    finest_resolution(box, kMostMaterialBytes), kMostMaterialBytes / kGigabyte));
  }
  DexelGrid grid(DexelLayout::of(box, resolution));
  stock.fill(grid);
  if (!(grid.volume_mm3() > 0)) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("no ray of a resolution of {} mm meets the stock of {:.4g} x {:.4g} x {:.4g} mm; choose a "
                    "finer one",
                    resolution, size[0], size[1], size[2]));
  }
  return grid;
}

}  // namespace rmac::gateway
