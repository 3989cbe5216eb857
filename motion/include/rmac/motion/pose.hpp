#pragma once

#include <array>
#include <cstddef>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

using Vector = std::array<double, 3>;

/// A rigid pose: `p` in mm, `q` a unit quaternion w, x, y, z that turns vectors of this frame into the parent's.
struct Frame {
  Vector p{0, 0, 0};
  std::array<double, 4> q{1, 0, 0, 0};
};

/// Frames in force for a move: machine = part · program, and the tool tip on the tool interface.
struct Frames {
  Frame part;
  Frame tool;
};

/// The tool as a five-axis path sees it: tip in mm, and the unit axis that points from the tip to the spindle.
struct ToolPose {
  Vector tip{0, 0, 0};
  Vector axis{0, 0, 1};
};

}  // namespace rmac
