#pragma once

#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/feed_rule.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// Largest ratio of a joint's or the path's demand to its limit along a law, sampled independently of how the law was
/// made.
struct LawExcess {
  double worst = 0;  ///< 1 is just at a limit; infinite where the law means nothing
  std::vector<double> by_piece;
};

/// Without `feed` the programmed feed is no bound: what is faster than a feed that was lowered must brake first.
[[nodiscard]] LawExcess check_law(const PathView& path, const std::vector<JointLimits>& joints,
                                  const std::vector<LawPiece>& law, const FeedRule* feed);

}  // namespace rmac
