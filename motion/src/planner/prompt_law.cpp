#include "planner/prompt_law.hpp"

#include <algorithm>
#include <utility>

#include "planner/laid_path.hpp"
#include "time_law/braking_law.hpp"
#include "time_law/law_check.hpp"
#include "time_law/law_problem.hpp"

namespace rmac {
namespace {

/// Steps of all laws that are tried for one answer, those of a check among them.
constexpr int kMostLawSteps = 1800;
/// A piece is checked at five places or more, a step looks at one.
constexpr int kStepsACheck = 4;
constexpr std::size_t kCheckedAtOnce = 16;
/// A way to brake: so many cycles later on the plan, by `Braking::most_slowing`.
struct Way {
  int later = 0;
  double slowing = kInfinity;
};
/// In the order in which they are tried: who brakes gently takes long, and who brakes hard a little later often rests
/// sooner.
constexpr Way kWays[] = {{0}, {0, 4}, {5}, {10}, {20}, {20, 4}, {40}, {0, 1}, {80}, {160}};

/// Checks piece by piece, so that one in excess is not paid for by all.
bool keeps_limits(const LeftPlan& left, const std::vector<LawPiece>& law, const FeedRule* feed, int& steps_left) {
  for (std::size_t first = 0; first < law.size(); first += kCheckedAtOnce) {
    const std::size_t last = std::min(first + kCheckedAtOnce, law.size());
    const auto from = law.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<LawPiece> some(from, law.begin() + static_cast<std::ptrdiff_t>(last));
    steps_left -= kStepsACheck * static_cast<int>(some.size());
    if (check_law(left.path, left.joints, some, feed).worst > 1) return false;
  }
  return true;
}

}  // namespace

std::optional<PromptLaw> prompt_stop(const LeftPlan& left, double rest, const FeedRule& feed, int later) {
  int steps_left = kMostLawSteps;
  for (const Way& way : kWays) {
    if (steps_left <= 0) break;
    const double t = left.t + (later + way.later) * left.period_s;
    const PathState from = left.plan.state_at(t);
    if (!(from.v > 0) || from.s >= rest - kSamePlace) continue;
    auto law = braking_law(left.path, left.joints, {from, rest, left.plan.law, way.slowing}, steps_left);
    if (!law) continue;
    // What goes faster than a feed that was lowered must brake first.
    const bool too_fast = from.v > feed.bound(left.path.segment(left.path.find(from.s, 1)));
    if (keeps_limits(left, *law, too_fast ? nullptr : &feed, steps_left))
      return PromptLaw{t, std::move(*law), way.later > 0 || way.slowing < kInfinity};
  }
  return std::nullopt;
}

}  // namespace rmac
