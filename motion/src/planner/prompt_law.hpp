#pragma once

#include <optional>
#include <vector>

#include "planner/published_plan.hpp"
#include "rmac/motion/limits.hpp"
#include "time_law/path_view.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// What is found at once when a plan is to be left: it is followed up to a time of it, and then this law, whose times
/// begin at 0. Checked.
struct PromptLaw {
  double leaves_t = 0;
  std::vector<LawPiece> law;
  bool makeshift = false;  ///< a better one is likely to be found by who has more time
};

/// A plan that is followed, and what it is left for.
struct LeftPlan {
  const PathView& path;
  const std::vector<JointLimits>& joints;
  const PublishedPlan& plan;
  double t = 0;         ///< from this time of it on
  double period_s = 0;  ///< of the servo cycle
};

/// To come to rest before path length `rest`: braking as hard as the limits allow, more gently, or later on the plan.
/// The work is bounded. Nothing where none of it passed its check; then the plan's own way to rest is what there is.
/// `feed`: what it was made for. `later`: cycles for which the plan is followed on in any case.
[[nodiscard]] std::optional<PromptLaw> prompt_stop(const LeftPlan& left, double rest, const FeedRule& feed, int later);

}  // namespace rmac
