#pragma once

#include <span>
#include <vector>

#include "time_law/path_view.hpp"

namespace rmac {

/// One end of a grid: steps are no longer than `step` at `graded_from`, at the end or beyond it, and grow with the
/// distance from there.
struct GridEnd {
  double s = 0;
  double graded_from = 0;
  double step = 0;
};

/// Path lengths from one end to the other on which a time law is made: segment ends and breaks are among them, steps
/// are as fine as the geometry asks and no longer than `coarsest`; places `kept` (ascending) are among them too. At
/// least 6.
[[nodiscard]] std::vector<double> law_grid(const PathView& path, const GridEnd& begin, const GridEnd& end,
                                           double coarsest, std::span<const double> kept);

}  // namespace rmac
