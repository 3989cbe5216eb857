#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"

namespace rmac {

/// A stretch of path to be given a time law: from a state to rest at `s_end`. The path between is smooth to the second
/// derivative.
struct Window {
  PathState begin;  ///< v = a = 0: from rest
  double s_end = 0;
  double override_factor = 1;  ///< on the programmed feed
  const std::vector<LawPiece>* before =
      nullptr;  ///< the law that the window's begin state was taken from: a good first guess
};

/// The fastest checked time law of a window, beginning at time 0, or nothing when none passed its check. From rest
/// there is always one.
[[nodiscard]] std::optional<std::vector<LawPiece>> plan_window(const PathView& path,
                                                               const std::vector<JointLimits>& joints,
                                                               const Window& window);

/// Largest ratio of a joint's or the path's demand to its limit along a law, sampled independently of how the law was
/// made.
struct LawExcess {
  double worst = 0;  ///< 1 is just at a limit
  std::vector<double> by_piece;
};
[[nodiscard]] LawExcess check_law(const PathView& path, const std::vector<JointLimits>& joints,
                                  const std::vector<LawPiece>& law, double override_factor);

/// Length of the ramp from rest to speed v (mm) under acceleration a and jerk j.
[[nodiscard]] double ramp_length(double v, double a, double j) noexcept;

/// Law of a rest-to-rest stretch that keeps every limit with room to spare whatever the path does: constant bounds of
/// speed, acceleration and jerk, each term of a joint's demand having a third of the limit. Slow, and never without an
/// answer.
[[nodiscard]] std::vector<LawPiece> cautious_law(const PathView& path, const std::vector<JointLimits>& joints,
                                                 double s_begin, double s_end, double override_factor);

}  // namespace rmac
