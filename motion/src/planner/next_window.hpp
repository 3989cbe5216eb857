#pragma once

#include <optional>
#include <vector>

#include "planner/laid_path.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/feed_rule.hpp"

namespace rmac {

/// A window holds this many ramps to full speed: few where its law is needed at once, many where motion goes on.
inline constexpr double kRampsAtOnce = 5;
inline constexpr double kRampsAhead = 16;

/// Where a window ends, and whether the path demands rest there.
struct WindowEnd {
  double s = 0;
  bool hard = false;
  double planned_again = 0;  ///< length before the end that a following window plans again
};

/// Where the window that begins at s must or may end: at a demanded rest, at `limit_s`, at the end of the path, or
/// where it is long enough, which takes `ramps` ramps to full speed. Lays path until it is known. `factor`: the
/// override.
[[nodiscard]] WindowEnd next_window_end(LaidPath& path, const std::vector<JointLimits>& joints, double s, double ramps,
                                        double factor, std::optional<double> limit_s);

/// The law of a window from rest, which may end earlier than asked (`end.hard` is then cleared): what is too much for
/// one window may be found in parts, and where nothing is found the cautious law creeps over a short part only.
[[nodiscard]] std::optional<std::vector<LawPiece>> law_from_rest(const PathView& path,
                                                                 const std::vector<JointLimits>& joints, double s,
                                                                 WindowEnd& end, const FeedRule& feed);

}  // namespace rmac
