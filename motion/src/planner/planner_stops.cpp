#include <algorithm>
#include <array>
#include <iterator>

#include "gives_way.hpp"
#include "planner/planner_impl.hpp"
#include "planner/stop_distance.hpp"

namespace rmac {
namespace {

/// Stops that are looked for once one was found at once end after so much of the shortest way that is thought possible;
/// so many windows are tried, and one is worth it that ends sooner by this part of what is left.
constexpr std::array<double, 8> kStretches{1.02, 1.08, 1.2, 1.4, 1.8, 2.5, 4.0, 7.0};
constexpr int kStopTries = 400;
constexpr double kWorthIt = 0.05;
/// And for an override, which is tried again in the next cycle.
constexpr int kOverrideTries = 3;
constexpr std::int64_t kUrgent = 1;
/// How a plan is left for an override, in the order in which it is tried. In near-cusps the state lies at the edge of
/// the limits, and a little later it does not; nor is there room there to brake for a feed as fast as elsewhere.
constexpr double kHardlyBraking = 0.06;
constexpr Leaving kLeavings[] = {{0},  {2, kHardlyBraking},  {5},  {8, kHardlyBraking},  {12}, {16, kHardlyBraking},
                                 {24}, {32, kHardlyBraking}, {48}, {64, kHardlyBraking}, {96}, {128, kHardlyBraking}};
/// What leaves later is followed by tries to leave sooner, a cycle each, until its plan is there; no more than these,
/// for nothing is added to it meanwhile.
constexpr int kTakenOver = 2, kMostSoonerTries = 30;
/// Braking for an override begins so many cycles later: mostly the law that is looked for meanwhile comes first, and
/// finds its way more easily from the plan that is followed than from one that brakes.
constexpr int kBeforeBraking = 6;

}  // namespace

bool Planner::Impl::brake(const ServoProgress& progress, std::int64_t lead, double rest, Purpose purpose) {
  const PublishedPlan& p = *base();
  const std::int64_t cycle = p.followed_from(progress.cycle + lead);
  const FeedRule rule = feed(std::max(factor, p.override_factor));
  const PathView view = path().view();
  const auto found = prompt_stop({view, model.joints, p, now_s(p, cycle), model.period_s}, rest, rule,
                                 purpose.stops ? 0 : kBeforeBraking);
  if (!found || (base()->purpose.stops && !ends_sooner(*found))) return false;
  if (purpose.stops && !found->makeshift) purpose.better_tries = 0;
  auto plan = go_on_as(p, cycle, found->leaves_t, found->law, model.period_s);
  plans.go_on_from_base(*plan, progress);
  return publish(std::move(plan), {rest, false}, p.state_at(found->leaves_t).s, purpose);
}

bool Planner::Impl::follow_override(const ServoProgress& progress) {
  PublishedPlan& p = *plans.base();
  int& tries = p.purpose.better_tries;
  if (tries == 0) {
    // What neither feed slows down is what would be found for the other, too, where nothing is planned beyond its end.
    const bool final = p.hard_end || p.end_s() >= path().end() - kSamePlace;
    const FeedRule slower = feed(std::min(factor, p.override_factor));
    if (final && !p.slowed_by(slower, path().view(), now_s(p, progress.cycle))) {
      p.override_factor = factor;
      return false;
    }
    const double rest = rest_behind(p, p.followed_from(progress.cycle + PlanningTime::kShortestLead));
    const bool hurry = factor < p.override_factor || attempt.was_based_on(p.plan->id);
    if (hurry && brake(progress, PlanningTime::kShortestLead, rest, {false, kOverrideTries})) return true;
    tries = kOverrideTries;
    if (hurry) return false;
  }
  const std::size_t ways = factor == p.override_factor ? 1 : std::size(kLeavings);
  const Leaving& way = kLeavings[std::min(leaving_attempt, ways - 1)];
  if (divert(progress, std::nullopt, way)) {
    // Until it leaves, one may be found that leaves sooner.
    plans.base()->purpose.better_tries = std::clamp(way.later - kTakenOver, 0, kMostSoonerTries);
    return true;
  }
  if (gives_way()) return false;
  if (++leaving_attempt < ways) return false;
  leaving_attempt = 0;
  --tries;
  return no_plan(progress, kUrgent);
}

double Planner::Impl::rest_behind(const PublishedPlan& p, std::int64_t cycle) const {
  return path().next_rest(p.state_at(now_s(p, cycle)).s, base_end_s());
}

bool Planner::Impl::stop(const ServoProgress& progress) {
  // Of a plan that is not taken over yet, only what is the plan's before too is sure to be followed.
  const bool patient = stop_came_late && plans.acknowledged(progress);
  const std::int64_t lead = patient ? planning_time.lead() : PlanningTime::kShortestLead;
  // The rest ends every search: the plan itself comes to rest there.
  const double rest = rest_behind(*base(), base()->followed_from(progress.cycle + lead));
  return brake(progress, lead, rest, {true, kStopTries}) || end_at_rest(progress, rest);
}

bool Planner::Impl::end_at_rest(const ServoProgress& progress, double rest) {
  const PublishedPlan& p = *base();
  if (rest >= base_end_s() - kSamePlace) {
    plans.base_stops(kStopTries);
    return true;
  }
  const std::int64_t now = p.followed_from(progress.cycle);
  auto plan = go_on_as(p, now, p.time_at(rest - kSamePlace), {}, model.period_s);
  if (plan->law.empty()) return no_plan(progress);
  plans.go_on_from_base(*plan, progress);
  return publish(std::move(plan), {rest, true}, rest, {true, kStopTries});
}

bool Planner::Impl::ends_sooner(const PromptLaw& found) const {
  const PublishedPlan& p = *base();
  const double end = found.law.back().at(found.law.back().duration).s, begin = p.state_at(found.leaves_t).s;
  return end < base_end_s() - kWorthIt * (base_end_s() - begin);
}

bool Planner::Impl::stop_sooner(const ServoProgress& progress) {
  PublishedPlan& p = *plans.base();
  const std::int64_t cycle = p.followed_from(progress.cycle + planning_time.lead());
  const PathState from = p.state_at(now_s(p, cycle));
  const double shortest = from.v > 0 ? stop_distance(path().view(), model.joints, from) : 0;
  int& tries = p.purpose.better_tries;
  const std::size_t stretch = static_cast<std::size_t>(kStopTries - tries) % kStretches.size();
  const double s_end = from.s + shortest * kStretches[stretch];
  --tries;
  if (stretch == 0 && brake(progress, planning_time.lead(), rest_behind(p, cycle), {true, tries})) return true;
  if (from.v > 0 && s_end < base_end_s() - kWorthIt * (base_end_s() - from.s)) {
    if (divert(progress, s_end, {})) return true;
    if (stretch + 1 < kStretches.size()) return false;
  } else {
    tries -= static_cast<int>(kStretches.size() - 1 - stretch);  // the longer ones are no better
  }
  return no_plan(progress);
}

}  // namespace rmac
