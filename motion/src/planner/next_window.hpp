#pragma once

#include <optional>
#include <vector>

#include "planner/laid_path.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// A window holds this many ramps to full speed: few where its law is needed at once, many where motion goes on.
inline constexpr double kRampsAtOnce = 5;
inline constexpr double kRampsAhead = 16;

/// Nodes of the geometry after which a window ends, unless it is still shorter than a few ramps from the speed at its
/// begin: a law's grid has about three intervals to each. More would hold the planner up; what answers an override has
/// few.
inline constexpr std::size_t kMostNodes = 300;
inline constexpr std::size_t kNodesAtOnce = 20;

/// Where a window ends, and whether the path demands rest there.
struct WindowEnd {
  double s = 0;
  bool hard = false;
  double planned_again = 0;  ///< length before the end that a following window plans again
  bool in_work = false;      ///< this call took the work of laying path that a step may do; the next one may know more
};

/// Where the window that begins at s must or may end: at a demanded rest, at `limit_s`, at the end of the path, or
/// where it is long enough, which takes `ramps` ramps to full speed, or where the path bends so much that it would have
/// more than `most_nodes` nodes. Lays path until it is known, or the path has taken as much work as a step may do.
/// `from`: the state in which it begins; `factor`: the override.
[[nodiscard]] WindowEnd next_window_end(LaidPath& path, const std::vector<JointLimits>& joints, const PathState& from,
                                        double ramps, double factor, std::optional<double> limit_s,
                                        std::size_t most_nodes = kMostNodes);

/// Work that one step of the planner may do on a law (`LawProblem::work_left`).
inline constexpr long kMostWorkOnLaw = 80'000;
/// Attempts at the law of a window from rest, one a step of the planner.
inline constexpr std::size_t kAttemptsFromRest = 5;

/// The law of a window from rest, which may end earlier than asked (`end.hard` is then cleared): what is too much for
/// one window may be found in parts, a shorter one with each attempt, and where nothing is found the last creeps over a
/// short part only, by the cautious law.
[[nodiscard]] std::optional<std::vector<LawPiece>> law_from_rest(const PathView& path,
                                                                 const std::vector<JointLimits>& joints, double s,
                                                                 WindowEnd& end, const FeedRule& feed,
                                                                 std::size_t attempt);

}  // namespace rmac
