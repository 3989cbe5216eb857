#include <algorithm>
#include <array>

#include "gives_way.hpp"
#include "planner/horizon_limit.hpp"
#include "planner/planner_impl.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

/// Ramps of a window that goes on in motion, an attempt.
constexpr std::array kRampsInMotion{kRampsAhead, kRampsAtOnce};
/// And of one for a raised override: enough to be fast in, found sooner and more often than a longer one.
constexpr double kRampsFaster = 2.5;

}  // namespace

WindowEnd Planner::Impl::window_end(const PathState& from, double ramps, std::size_t most_nodes) {
  const auto limit = wanted == PathCommand::RunOne && !route.on_detour() ? std::optional(limit_s) : std::nullopt;
  const WindowEnd end = next_window_end(path(), model.joints, from, ramps, factor, limit, most_nodes);
  if (end.in_work) planning_time.withdraw();
  return end;
}

bool Planner::Impl::publish(std::unique_ptr<Plan> plan, const WindowEnd& end, double window_begin,
                            const Purpose& purpose) {
  plan->origin_mm = origin_mm;
  lay_out(*plan, path(), model.period_s);
  PublishedPlan about;
  about.purpose = purpose;
  about.hard_end = end.hard;
  about.turns = route.turns();
  about.override_factor = factor;
  about.commit_t = commit_time(*plan, window_begin, end.planned_again);
  const LawPiece& last = plan->law.back();
  plan->limit = horizon_limit(route, {wanted, factor, limit_s, rest_follows}, last.at(last.duration).s, &about);
  law_attempt = leaving_attempt = 0;
  return plans.publish(std::move(plan), std::move(about));
}

bool Planner::Impl::start_from_rest(const ServoProgress& progress) {
  const double s = base_end_s();
  WindowEnd end = window_end({s, 0, 0}, kRampsAtOnce);
  if (end.in_work) return false;
  auto law = law_from_rest(path().view(), model.joints, s, end, feed(factor), law_attempt);
  if (!law) return next_attempt(progress, kAttemptsFromRest);
  auto plan = std::make_unique<Plan>();
  plan->start_cycle = progress.cycle + planning_time.lead();
  plan->latest_cycle = plan->start_cycle;
  plan->law = std::move(*law);
  return publish(std::move(plan), end, s);
}

bool Planner::Impl::extend(const ServoProgress& progress) {
  const PublishedPlan& p = *base();
  const std::int64_t now = p.followed_from(progress.cycle);
  const double t_now = now_s(p, now);
  const double t_soonest = t_now + static_cast<double>(planning_time.lead()) * model.period_s;
  // Too near the end to be there in time: the machine comes to rest, and starts again from there.
  if (t_soonest > p.plan->end_time_s) return no_plan(progress);
  double t_from = p.plan->end_time_s;
  // A state from which no window was found is not asked again: the next attempt is from a sooner one.
  if (!p.hard_end) t_from = std::clamp(attempt.was_based_on(p.plan->id) ? t_soonest : p.commit_t, t_soonest, t_from);
  const PathState from = p.state_at(t_from);
  WindowEnd end;
  std::optional<std::vector<LawPiece>> law;
  std::size_t attempts = kAttemptsFromRest;
  if (from.v == 0 && from.a == 0) {
    end = window_end(from, kRampsAtOnce);
    if (end.in_work) return false;
    law = law_from_rest(path().view(), model.joints, from.s, end, feed(factor), law_attempt);
  } else {
    long work_left = kMostWorkOnLaw;
    law_attempt = std::min(law_attempt, kRampsInMotion.size() - 1);
    end = window_end(from, kRampsInMotion[law_attempt]);
    if (end.in_work) return false;
    law = plan_window(path().view(), model.joints, {from, end.s, feed(factor), &p.law, true, true, &work_left});
    // Where the path or its next rest is near, fewer ramps make the same window.
    attempts = !law && window_end(from, kRampsInMotion.back()).s < end.s ? kRampsInMotion.size() : 1;
  }
  if (!law) return next_attempt(progress, attempts);
  return publish(go_on_as(p, now, t_from, *law, model.period_s), end, from.s);
}

bool Planner::Impl::divert(const ServoProgress& progress, std::optional<double> s_stop, const Leaving& leaving) {
  const PublishedPlan& p = *base();
  const std::int64_t cycle = p.followed_from(progress.cycle + planning_time.lead());
  const double t = now_s(p, cycle + leaving.later);
  const PathState from = p.state_at(t);
  if (!(from.v > 0)) return false;
  const double ramps = factor > p.override_factor ? kRampsFaster : kRampsAtOnce;
  const WindowEnd end = s_stop ? WindowEnd{*s_stop, false} : window_end(from, ramps, kNodesAtOnce);
  const double allowed = s_stop ? std::max(factor, p.override_factor) : factor;
  const bool same_feed = s_stop.has_value() || p.override_factor == factor;
  long work_left = kMostWorkOnLaw;
  Window window{from, end.s, feed(allowed), &p.law, same_feed, false, &work_left};
  window.braking = leaving.braking;
  auto law = plan_window(path().view(), model.joints, window);
  if (!law) return false;
  return publish(go_on_as(p, cycle, t, *law, model.period_s), end, from.s, {s_stop.has_value(), 0});
}

bool Planner::Impl::next_attempt(const ServoProgress& progress, std::size_t attempts) {
  if (gives_way()) return false;
  if (++law_attempt < attempts) return false;
  law_attempt = 0;
  return no_plan(progress);
}

bool Planner::Impl::no_plan(const ServoProgress& progress, std::int64_t retry_after) {
  if (gives_way()) return false;  // it was not tried to the end
  attempt.record(progress.cycle, base() == nullptr ? 0 : base()->plan->id, plans.ended(progress), retry_after);
  return false;
}

}  // namespace rmac
