#pragma once

#include <vector>

#include "rmac/motion/pose.hpp"
#include "splines/line_spline.hpp"
#include "tubes/tube_program.hpp"

namespace rmac {

/// The smoothest quintic spline over `knots` (least ∫|S'''|²) that stays within widths_mm[k] of line k of the polyline,
/// and near each vertex where it should (docs/derivations/joins.md, section 7). It begins in the middle of line 0 where
/// the first knot says so. The first `kept` of `points` are given and stay; the last becomes the last vertex; the
/// others are found. False where there is none, or numbers fail.
[[nodiscard]] bool smoothest_in_tube(const std::vector<double>& knots, const Polyline& polyline,
                                     const std::vector<double>& widths_mm, std::size_t kept,
                                     std::vector<Vector>& points);

/// Bounds of a spline over `knots` for `program`: those of `smoothest_in_tube`.
void lay_tube_samples(const std::vector<double>& knots, const Polyline& polyline, const std::vector<double>& widths_mm,
                      std::size_t kept, TubeProgram& program);

/// For each line a bound of the distance between the spline's stretch and the polyline, both ways; rigorous up to
/// `most_mm`, and above that only more than `most_mm` (eq. 14).
[[nodiscard]] std::vector<double> tube_distances(const std::vector<double>& knots, const std::vector<Vector>& points,
                                                 const Polyline& polyline, double most_mm);
/// The largest part of what the polyline, which itself misses what was sent by `off_mm`, leaves of `most_mm`.
[[nodiscard]] double largest_part(const std::vector<double>& distances, const Polyline& polyline, double most_mm);

}  // namespace rmac
