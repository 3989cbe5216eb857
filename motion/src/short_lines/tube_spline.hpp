#pragma once

#include <vector>

#include "rmac/motion/pose.hpp"
#include "short_lines/draft_law.hpp"
#include "short_lines/line_spline.hpp"

namespace rmac {

/// The smoothest quintic spline over `knots` (least ∫|S'''|²) that stays within widths_mm[k] of line k of the polyline,
/// and near each vertex where it should (docs/derivations/joins.md, section 7). It begins in the middle of line 0 where
/// the first knot says so. The first `kept` of `points` are given and stay; the last becomes the last vertex; the
/// others are found. False where there is none, or numbers fail.
[[nodiscard]] bool smoothest_in_tube(const std::vector<double>& knots, const Polyline& polyline,
                                     const std::vector<double>& widths_mm, std::size_t kept,
                                     std::vector<Vector>& points);

/// Makes a spline in the tube, with what is as in `smoothest_in_tube`, faster to travel: within the tolerance by
/// `tube_distances`, which then become `deviations_mm`, or all is left as it is.
void fastest_in_tube(const std::vector<double>& knots, const Polyline& polyline, std::vector<double> widths_mm,
                     double tolerance_mm, std::size_t kept, DraftLaw& law, std::vector<Vector>& points,
                     std::vector<double>& deviations_mm);

/// For each line a bound of the distance between the spline's stretch and the polyline, both ways; rigorous up to
/// `most_mm`, and above that only more than `most_mm` (eq. 14).
[[nodiscard]] std::vector<double> tube_distances(const std::vector<double>& knots, const std::vector<Vector>& points,
                                                 const Polyline& polyline, double most_mm);
/// The largest part of what the polyline, which itself misses what was sent by `off_mm`, leaves of `most_mm`.
[[nodiscard]] double largest_part(const std::vector<double>& distances, const Polyline& polyline, double most_mm);

}  // namespace rmac
