#pragma once

#include <Eigen/Core>
#include <vector>

#include "gateway/forces/turn_forces.hpp"
#include "gateway/material/dexel_grid.hpp"
#include "gateway/material/sweep/stroke_maker.hpp"

namespace rmac::gateway {

/// Where the edges of an end mill are in material.
struct Engagement {
  std::vector<EngagedSlice> slices;  ///< from the tip up; none: it is in the air
  bool face = false;                 ///< and the tool goes down into material with the face of its flat end
};

/// Of a tool that stands there and goes by `way` (part frame, any length but 0): places of its surface which face that
/// way and have material before them. Each is tried on the ray nearest to it, of the family along which the surface is
/// the steepest, where that ray leaves the tool: so the ends of slices and arcs are right to about the distance of the
/// rays. `ahead_mm`: so far before it the tool is taken to be, so that what it cut itself up to there does not count.
[[nodiscard]] Engagement engagement_of(const EndMill& mill, const DexelGrid& grid, const ToolAt& tool,
                                       const Eigen::Vector3d& way, double ahead_mm);

}  // namespace rmac::gateway
