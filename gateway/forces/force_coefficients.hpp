#pragma once

namespace rmac::gateway {

/// How a work material resists a cutting edge: what shears a chip of 1 mm² (N/mm²), and what rubs along 1 mm of edge
/// (N/mm), in the direction of the cut, towards the tool's axis and along the edge's profile (Altintas, Manufacturing
/// Automation, 2nd ed., sec. 2.8).
struct ForceCoefficients {
  double ktc = 0, krc = 0, kac = 0;  ///< N/mm²
  double kte = 0, kre = 0, kae = 0;  ///< N/mm
};

}  // namespace rmac::gateway
