#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// How a path is braked.
struct Braking {
  PathState begin;                      ///< in motion
  double s_latest = 0;                  ///< rest comes before this path length
  const std::vector<LawPiece>& leaves;  ///< the law that the state was taken from
  /// How fast the motion may become slower than that law, as a part of its speed (1/s). Who brakes gently keeps what
  /// that law knows of the bends that come, and may get through where who brakes hard does not.
  double most_slowing = std::numeric_limits<double>::infinity();
};

/// A law from a state in motion to rest, beginning at time 0, found step by step: at each the path brakes as hard as
/// the joints' limits allow where the step ends, and lets go in time; where that leads to no way on, the last steps are
/// taken again, more gently (docs/derivations/time-law.md, section 7). There is not always one, nor is it always the
/// shortest, but it is found at once: every step takes one from `steps_left`. It is not checked.
[[nodiscard]] std::optional<std::vector<LawPiece>> braking_law(const PathView& path,
                                                               const std::vector<JointLimits>& joints,
                                                               const Braking& braking, int& steps_left);

}  // namespace rmac
