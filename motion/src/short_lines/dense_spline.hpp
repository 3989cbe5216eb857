#pragma once

#include <functional>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "splines/line_spline.hpp"

namespace rmac {

/// A window of lines that a spline is to follow.
struct DenseLines {
  const Polyline& polyline;
  double tolerance = 0;   ///< of what samples are missed by: mm, or rad of the tool axis
  double most = 0;        ///< the same where the window before has shaped it, perhaps in a tube as wide as this
  double overlap_mm = 0;  ///< at its end, which the next window fits again
  /// So far from a corner with another move at its start and its end, half of the tolerance is left for the blend
  /// there; 0 where there is none.
  double start_corner_mm = 0, end_corner_mm = 0;
  /// Of knots, where samples tell more than the lines' ends; otherwise by the lines' length.
  std::optional<double> least_step_mm = std::nullopt;
  std::optional<double> knot_at = std::nullopt;  ///< a place where a knot is to be
};

/// The spline within the tolerance of every line that is as smooth as can be found: rounding is smoothed away, and what
/// the curve is remains (docs/derivations/joins.md, section 6). It goes on from `before`. Nothing where the lines are
/// too coarse for it, or numbers fail: how far the best one found keeps what it may. Its cost is bounded for a length
/// and a number of lines.
[[nodiscard]] tl::expected<LineSpline, double> smoothest_along(const DenseLines& lines, const LineSpline& before);

/// Finds the control points of a trial, on its knots and for its samples' widths, those that it keeps being given;
/// tells the samples by how much it may miss them. Its roughness, or nothing where numbers fail.
using SmoothFit = std::function<std::optional<double>(LineSpline& trial)>;

/// The same search for splines of another kind through samples of their own.
[[nodiscard]] tl::expected<LineSpline, double> smoothest_within(const DenseLines& lines, const LineSpline& before,
                                                                std::vector<SplineSample> samples,
                                                                const SmoothFit& fit);

}  // namespace rmac
