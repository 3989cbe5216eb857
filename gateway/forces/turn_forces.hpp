#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gateway/forces/end_mill.hpp"
#include "gateway/forces/force_coefficients.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Between which angles a tooth is in material, rad: 0 is 90° to the left of the feed, and teeth turn clockwise as seen
/// from the spindle, so that a tooth meets what lies straight ahead at 90°. A slot is 0 to π. `exit` > `entry`.
struct Arc {
  double entry = 0, exit = 0;
  [[nodiscard]] bool operator==(const Arc&) const = default;
};

/// A slice of the tool across its axis, from the tip up, and where in it teeth are in material; arcs do not overlap.
struct EngagedSlice {
  double from_mm = 0, to_mm = 0;
  std::vector<Arc> arcs;
};

/// How far the tool goes from one tooth to the next, mm.
struct ToothFeed {
  double across_mm = 0;  ///< at a right angle to its axis; not negative
  double along_mm = 0;   ///< along its axis towards the spindle; negative: it plunges
};

/// Over one turn of the tool.
struct OverTurn {
  double mean = 0;
  double peak = 0;  ///< the value that is the farthest from 0, with its sign
};

/// What acts on the tool over one turn.
struct TurnForces {
  OverTurn tangential_n;        ///< all teeth's, against their motion
  OverTurn x_n, y_n, z_n;       ///< x along the feed across the axis, z along the axis to the spindle, right-handed
  OverTurn total_n;             ///< length of the vector; `mean`: of the mean vector
  OverTurn torque_nm, power_w;  ///< that the spindle gives
};

/// The mechanistic model of milling forces: a piece of edge whose profile is db long, and the edge itself dS, gives
/// K_c·h·db + K_e·dS in each of three directions, where the chip is h = across·sin(φ)·sin(κ) - along·cos(κ) thick
/// (S. Engin, Y. Altintas, Mechanics and dynamics of general milling cutters, part I, Int. J. Mach. Tools Manuf. 41,
/// 2001; Y. Altintas, Manufacturing Automation, 2nd ed., ch. 2; docs/forces.md). An edge cuts where it is in an arc and
/// h is not negative; without feed it rubs. Means are exact in the angle; peaks are those of at least 360 positions of
/// the tool over a turn, and of those at which an edge enters or leaves at the end of a slice.
///
/// Refused: slices above the flutes, a spindle that stands, a feed per tooth beyond the tool's radius.
[[nodiscard]] Expected<TurnForces> forces_over_turn(const EndMill& mill, const ForceCoefficients& material,
                                                    std::span<const EngagedSlice> slices, const ToothFeed& feed,
                                                    double spindle_rpm);

/// By how much the force on the tool changes, N/mm, with where it is against where the tooth before it was: a column
/// for each of x, y and z as `TurnForces` has them.
struct ChipStiffness {
  Eigen::Matrix3d mean;                     ///< over a turn
  std::vector<Eigen::Matrix3d> over_pitch;  ///< in the middles of equal parts of the turn from tooth to tooth
};

/// Edges alone change nothing. Where there is a chip is taken as the feed leaves it (Y. Altintas, Manufacturing
/// Automation, 2nd ed., ch. 4). Refused as `forces_over_turn`.
[[nodiscard]] Expected<ChipStiffness> chip_stiffness(const EndMill& mill, const ForceCoefficients& material,
                                                     std::span<const EngagedSlice> slices, const ToothFeed& feed,
                                                     int positions);

/// The chip that the model takes, mm³/s.
[[nodiscard]] double removal_rate_mm3_s(const EndMill& mill, std::span<const EngagedSlice> slices,
                                        const ToothFeed& feed, double spindle_rpm);

}  // namespace rmac::gateway
