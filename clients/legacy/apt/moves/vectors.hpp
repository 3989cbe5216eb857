#pragma once

#include "clients/legacy/program/vectors.hpp"

namespace rmac::apt {

using legacy::dot, legacy::cross, legacy::along, legacy::difference, legacy::length, legacy::scaled;
using legacy::Point, legacy::Writer, legacy::Placement;

/// Where the tool is: its tip, in mm, and its axis, from the tip to the spindle and of unit length. In the coordinates
/// of the part.
struct Pose {
  Point tip{}, axis = legacy::unit_axis(2);
  bool operator==(const Pose&) const = default;
};

}  // namespace rmac::apt
