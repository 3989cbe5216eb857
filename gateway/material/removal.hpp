#pragma once

#include <Eigen/Geometry>

#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/sweep.hpp"

namespace rmac::gateway {

/// What a piece of a tool met on its way.
struct Removal {
  double volume_mm3 = 0;  ///< the mean of the three families
  /// The longest piece of material that a ray had within it, the least of the three families; 0: not every family met
  /// any, so that it is thinner than the rays are apart.
  double depth_mm = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< the middle of that piece, part frame
};

/// Whether material is taken away, or only looked at.
enum class Cut { Remove, Look };

/// Touches no ray but those in the box around the sweep, and of these no tile whose material the sweep passes by.
Removal cut(DexelGrid& grid, const Sweep& sweep, Cut what);

}  // namespace rmac::gateway
