#pragma once

#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Where a joint leaves its travel: by how much (with sign), and how far along the segment.
struct TravelOffence {
  std::size_t joint = 0;
  double position = 0, amount = 0, s = 0;
};

/// How far each joint is beyond its travel, with sign; 0 inside.
[[nodiscard]] std::vector<double> excess_of(std::span<const double> positions, const std::vector<JointLimits>& joints);

/// The first point of a resolved segment, node by node and at each joint's turning points between nodes, where a joint
/// leaves its travel. One that stands outside already (a load sagged before its drive held it) must not go further out;
/// `excess`, what `excess_of` tells of the segment's begin, becomes that of its end.
[[nodiscard]] std::optional<TravelOffence> find_offence(const PathSegment& segment,
                                                        const std::vector<JointLimits>& joints,
                                                        std::span<double> excess);
/// The same for a segment that begins inside.
[[nodiscard]] std::optional<TravelOffence> find_offence(const PathSegment& segment,
                                                        const std::vector<JointLimits>& joints);

}  // namespace rmac
