#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rmac/motion/follower/horizon.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/motion/time_law.hpp"

namespace rmac {

/// What the servo loop follows from `start_cycle` on: a stretch of path and the law by which it is travelled. Always
/// ends at rest, so a machine whose planner dies comes to rest on the path. Immutable once published.
struct Plan {
  std::uint64_t id = 0;
  std::int64_t start_cycle = 0;  ///< time 0 of the law
  /// Last cycle in which it may be taken over: until then it agrees with the plan before it.
  std::int64_t latest_cycle = 0;
  std::uint64_t departures = 0;  ///< what `PathDeparture::count` was when it was made; else it is not taken over
  PathSegments segments;
  /// Where path length is counted from, as far along the path as plans before it have moved their zero, in whole mm: a
  /// path length never grows so long that its rounding shows in what the joints are asked.
  double origin_mm = 0;
  std::vector<double> segment_start;  ///< path length at which each segment begins; same origin as the law's s
  std::vector<LawPiece> law;  ///< in time order, without gaps; ends with v = 0; the first may begin before time 0
  double end_time_s = 0;
  HorizonLimit limit = HorizonLimit::Planning;  ///< of what is planned, when it was published
};

}  // namespace rmac
