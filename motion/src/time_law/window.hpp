#pragma once

#include <optional>
#include <vector>

#include "rmac/motion/limits.hpp"
#include "rmac/motion/time_law.hpp"
#include "time_law/path_view.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// The part of what the joints allow with which a window slows down that begins too fast for its feed.
inline constexpr double kBraking = 0.25;

/// A stretch of path to be given a time law: from a state to rest at `s_end`. The path between is smooth to the second
/// derivative.
struct Window {
  PathState begin;  ///< v = a = 0: from rest
  double s_end = 0;
  FeedRule feed;
  const std::vector<LawPiece>* before =
      nullptr;                ///< the law that the window's begin state was taken from: a good first guess
  bool same_feed = false;     ///< `before` was made for this feed: where it is still faster, this law may be so too
  bool patient = false;       ///< there is time to look further for a law
  long* work_left = nullptr;  ///< `LawProblem::work_left`
  double braking = kBraking;  ///< less where the path's bends leave hardly any braking

  [[nodiscard]] bool from_rest() const noexcept { return begin.v == 0 && begin.a == 0; }
};

/// The fastest checked time law of a window, beginning at time 0, or nothing when none passed its check. From rest
/// there may still be one for a part of the window, and `cautious_law` is the last resort.
[[nodiscard]] std::optional<std::vector<LawPiece>> plan_window(const PathView& path,
                                                               const std::vector<JointLimits>& joints,
                                                               const Window& window);

/// Time that a change of speed by v takes under acceleration a and jerk j.
[[nodiscard]] double ramp_time(double v, double a, double j) noexcept;
/// Length of the ramp from rest to speed v (mm) under acceleration a and jerk j.
[[nodiscard]] double ramp_length(double v, double a, double j) noexcept;

/// Law of a rest-to-rest stretch that keeps every limit with room to spare whatever the path does: constant bounds of
/// speed, acceleration and jerk, each term of a joint's demand having a third of the limit. Slow, and never without an
/// answer.
[[nodiscard]] std::vector<LawPiece> cautious_law(const PathView& path, const std::vector<JointLimits>& joints,
                                                 double s_begin, double s_end, const FeedRule& feed);

}  // namespace rmac
