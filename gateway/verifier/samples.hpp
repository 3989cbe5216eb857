#pragma once

#include <vector>

#include "gateway/verification/checks/kinematics_check.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/limits.hpp"

// What a mechanism's modules are tried with.

namespace rmac::verifier {

/// Where a joint's positions are taken from: its travel, and two turns where that has no end.
[[nodiscard]] inline JointRange range_of(const JointLimits& limits) {
  constexpr double kRound = 720;
  const double least = ends_below(limits) ? limits.min : (ends_above(limits) ? limits.max - kRound : -kRound);
  const double most = ends_above(limits) ? limits.max : least + 2 * kRound;
  return {least, most};
}

inline constexpr std::size_t kSampleTools = 4;

/// Of none, a straight one, a long one off the spindle's line, and an angle head those that the geometry takes.
[[nodiscard]] inline std::vector<Frame> sample_tools(const Kinematics& kinematics) {
  std::vector<Frame> tools{Frame{},
                           {{0, 0, -80}, {1, 0, 0, 0}},
                           {{1, -2, 300}, {1, 0, 0, 0}},
                           normalized({{3, 0, 60}, {0.98, 0.1, -0.05, 0.1642}})};
  std::erase_if(tools, [&](const Frame& tool) { return !kinematics.takes(tool); });
  return tools;
}

}  // namespace rmac::verifier
