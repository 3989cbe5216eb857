#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/sweep/sweep.hpp"

namespace rmac::gateway {

/// What a piece of a tool met on its way.
struct Removal {
  std::array<double, 3> volumes_mm3{};  ///< as each family of rays sees it
  /// The longest piece of material that a ray had within it, the least of the three families; 0: not every family met
  /// any, so that it is thinner than the rays are apart. Unknown where it was not asked for.
  double depth_mm = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< the middle of that piece, part frame
};

enum class Cut {
  Remove,         ///< material is taken away
  RemoveAndTell,  ///< and how deep it was is told, sweep by sweep: it costs far more
  Look            ///< how deep it is is told, and it stays
};

/// Touches no ray but those in the boxes around the sweeps of one piece, and of these no tile whose material they pass
/// by. Sweeps that follow each other cost least together, with `Remove`: the rays of a tile meet no sweep but those of
/// which others do not take all that it takes there, and each ray is changed once.
Removal cut(DexelGrid& grid, std::span<const Sweep> sweeps, Cut what);
inline Removal cut(DexelGrid& grid, const Sweep& sweep, Cut what) {
  return cut(grid, std::span(&sweep, 1), what);
}

}  // namespace rmac::gateway
