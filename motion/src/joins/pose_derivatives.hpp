#pragma once

#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// A segment's pose in the part frame and its derivatives by path length up to the second, also where its curve tells
/// the rotary joints instead of how the tool axis turns.
[[nodiscard]] KinematicsStatus pose_derivatives(const PathSegment& segment, double s, int side, CurvePoint& point);

}  // namespace rmac
