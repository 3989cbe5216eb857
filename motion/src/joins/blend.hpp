#pragma once

#include <memory>
#include <span>
#include <vector>

#include "joins/corner_shape.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// A blend leaves `before` and enters `after` at this distance from where they meet, and lies between.
struct Blend {
  double reach = 0;
  std::shared_ptr<const PathSegment> segment;
};

/// The fastest blend of two segments that meet, within the tolerance of the second (docs/derivations/joins.md): tangent
/// and curvature of tip and tool axis are continuous, no point is further than the tolerance from the programmed path,
/// nor any point of that from the blend. It uses no more than `room` of either. Without a segment
/// where there is none: tolerance 0, joint moves, a turn on the spot, a place out of reach or travel.
/// `over`: lines between the two that are too short for joins of their own; the blend takes their place, and no point
/// of them is further than the tolerance from the blend. Its reach counts from either end of them.
[[nodiscard]] Blend make_blend(const PathSegment& before, std::span<const std::shared_ptr<const PathSegment>> over,
                               const PathSegment& after, double room, const std::vector<JointLimits>& joints);

/// No join of a segment that is shorter than this can use enough of it.
inline constexpr double kShortestBlended_mm = 0.1;

}  // namespace rmac
