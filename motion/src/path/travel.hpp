#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Where a joint leaves its travel: by how much (with sign), and how far along the segment.
struct TravelOffence {
  std::size_t joint = 0;
  double position = 0, amount = 0, s = 0;
};

/// The first point of a resolved segment, node by node and at each joint's turning points between nodes, where a joint
/// leaves its travel.
[[nodiscard]] std::optional<TravelOffence> find_offence(const PathSegment& segment,
                                                        const std::vector<JointLimits>& joints);

}  // namespace rmac
