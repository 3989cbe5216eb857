#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::curves {

/// Refuses data that are no curve, with the first offending value and the rule it breaks. `joint_count` is the
/// dimension that a curve in joint space must have.
[[nodiscard]] Expected<> check_nurbs(const NurbsGeometry& geometry, std::size_t joint_count);

}  // namespace rmac::curves
