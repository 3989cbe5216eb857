#pragma once

#include <tl/expected.hpp>

#include "short_lines/line_spline.hpp"
#include "short_lines/polyline.hpp"

namespace rmac {

/// A window of lines that a spline is to follow.
struct DenseLines {
  const Polyline& polyline;
  double tolerance_mm = 0;
  double most_mm = 0;     ///< the same where the window before has shaped it, perhaps in a tube as wide as this
  double overlap_mm = 0;  ///< at its end, which the next window fits again
  /// So far from a corner with another move at its start and its end, half of the tolerance is left for the blend
  /// there; 0 where there is none.
  double start_corner_mm = 0, end_corner_mm = 0;
};

/// The spline within the tolerance of every line that is as smooth as can be found: rounding is smoothed away, and what
/// the curve is remains (docs/derivations/joins.md, section 6). It goes on from `before`. Nothing where the lines are
/// too coarse for it, or numbers fail: how far the best one found keeps what it may. Its cost is bounded for a length
/// and a number of lines.
[[nodiscard]] tl::expected<LineSpline, double> smoothest_along(const DenseLines& lines, const LineSpline& before);

}  // namespace rmac
