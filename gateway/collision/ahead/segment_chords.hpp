#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac::gateway {

/// A stretch of a segment on which the joints go straight, or nearly so.
struct Chord {
  using Joints = std::array<double, kMaxJoints>;
  double from_s = 0, to_s = 0;  ///< path length on the segment
  Joints from{}, to{};
  Joints beside{};  ///< so far each joint may be from the straight way between
};

/// The segment's joints between two of its places, as chords: a stretch is halved until its joints at the middle and
/// the quarters lie within so much of the straight way. `most_beside`: of each joint, mm or degrees. Empty where the
/// joints are not known. Between two nodes of the segment its joints are smooth; across one they need not be.
[[nodiscard]] std::vector<Chord> chords_of(const PathSegment& segment, double from_s, double to_s,
                                           const Chord::Joints& most_beside);

}  // namespace rmac::gateway
