#pragma once

#include <memory>
#include <vector>

#include "path/trimmed_curve.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Adds the stretches of `from` between a and b, laid from `begin` to `end` of another segment.
void append_stretches(const PathSegment& from, double a, double b, double begin, double end,
                      std::vector<MoveStretch>& stretches);

/// The part of a segment between two path lengths, as a segment of its own. Backward it begins at `end`, and ends no
/// moves: those that ended there were done before.
[[nodiscard]] std::shared_ptr<const PathSegment> part_of(const PathSegment& whole, double begin, double end,
                                                         Direction direction = Direction::Forward);

}  // namespace rmac
