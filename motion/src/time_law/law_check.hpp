#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// Largest ratio of a joint's or the path's demand to its limit along a law, sampled independently of how the law was
/// made.
struct LawExcess {
  double worst = 0;  ///< 1 is just at a limit; infinite where the law means nothing
  std::vector<double> by_piece;
  /// A piece: where between its ends a joint's acceleration or jerk is most over its bound; nothing where none is.
  std::vector<std::optional<double>> peaks;
};

/// Without `feed` the programmed feed is no bound: what is faster than a feed that was lowered must brake first.
[[nodiscard]] LawExcess check_law(const PathView& path, const std::vector<JointLimits>& joints,
                                  const std::vector<LawPiece>& law, const FeedRule* feed);

}  // namespace rmac
