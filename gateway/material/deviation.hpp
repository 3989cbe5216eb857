#pragma once

#include <Eigen/Core>

#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/material/dexel_grid.hpp"

namespace rmac::gateway {

/// How what is left of the stock differs from the part that was to be made, seen from the part's surface. mm.
struct Deviation {
  double rest_mm = 0, gouge_mm = 0;  ///< the most that was left on the part, and that was cut into it
  Eigen::Vector3d rest_at{0, 0, 0}, gouge_at{0, 0, 0};  ///< in the part frame
  double within_share = 0;                              ///< of the part's surface, 0 to 1
  double surface_mm2 = 0;                               ///< that rays saw
};

/// `part`: a closed surface in the part frame. Each place of it is measured by the ray of the family that meets it the
/// steepest: from the part's surface to that of the material on the same ray, times the cosine between ray and normal.
/// That is the distance where both surfaces are flat. What is out of the tolerance is also looked for along the other
/// two axes, on the rays next to the place: the least of the three counts, which is no less than the distance but for
/// about the resolution.
[[nodiscard]] Deviation deviation_of(const DexelGrid& left, const TriangleMesh& part, double tolerance_mm);

}  // namespace rmac::gateway
