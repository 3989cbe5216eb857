#pragma once

#include <span>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

// Where a part lies, from points that were measured on it: the rigid transform that fits them best. machine = frame ·
// part, what SetPartFrame takes. mm.

namespace rmac::gateway {

/// A point that was measured on a surface: where it should be and the surface's outward unit normal there, both in the
/// part frame, and where it is, in the machine frame. `feature` groups points in the report.
struct SurfacePoint {
  std::string feature;
  Vector nominal{};
  Vector normal{};
  Vector measured{};
};

/// Best fit of points to surfaces: the sum of squares of their distances along the nominal normals is least; along the
/// surface they may lie anywhere, so that a probe that lands beside its nominal point shifts nothing. Exact for planes;
/// on curved surfaces to second order in the way beside it. Gauss-Newton on SE(3) with damping, from the best fit of
/// points to points (Arun, Huang and Blostein 1987, with Umeyama's sign). A set that lets the part shift or turn is
/// refused, and the message says along or about what.
[[nodiscard]] Expected<Frame> fit_surfaces(std::span<const SurfacePoint> points);

/// Deviations of one feature's points from nominal, once the part is aligned: along the normals, positive where there
/// is too much material.
struct FeatureDeviation {
  std::string feature;
  std::size_t points = 0;
  double mean_mm = 0;
  double rms_mm = 0;
  double worst_mm = 0;  ///< the one of largest absolute value, with its sign
};
/// The features of `points` in a part that lies at `frame`, in the order in which they come first.
[[nodiscard]] std::vector<FeatureDeviation> feature_deviations(std::span<const SurfacePoint> points,
                                                               const Frame& frame);

}  // namespace rmac::gateway
