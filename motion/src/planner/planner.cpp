#include "rmac/motion/planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "gives_way.hpp"
#include "planner/failed_attempt.hpp"
#include "planner/horizon_limit.hpp"
#include "planner/next_window.hpp"
#include "planner/planning_time.hpp"
#include "planner/prompt_law.hpp"
#include "planner/published_plans.hpp"
#include "planner/route.hpp"
#include "planner/stop_distance.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

/// Plans are made this far ahead of the servo loop; more would only be thrown away by a hold or an override.
constexpr double kHorizon_s = 0.4;
/// Path length is counted from a new origin once the tool is so far from the last: its rounding stays below 1e-12 mm.
constexpr double kFarthest_mm = 1000;
/// What is held back for the sake of a join is given out so long before the machine would have to brake for its lack.
constexpr double kRelease_s = 0.05;

/// Stops that are looked for once one was found at once end after so much of the shortest way that is thought possible;
/// so many windows are tried, and one is worth it that ends sooner by this part of what is left.
constexpr std::array<double, 8> kStretches{1.02, 1.08, 1.2, 1.4, 1.8, 2.5, 4.0, 7.0};
constexpr int kStopTries = 400;
constexpr double kWorthIt = 0.05;
/// And for an override. One that is lowered is tried again in the next cycle.
constexpr int kOverrideTries = 3;
constexpr std::int64_t kUrgent = 1;
/// Braking for an override begins so many cycles later: mostly the law that is looked for meanwhile comes first, and
/// finds its way more easily from the plan that is followed than from one that brakes.
constexpr int kBeforeBraking = 6;

/// Ramps of a window that goes on in motion, an attempt.
constexpr std::array kRampsInMotion{kRampsAhead, kRampsAtOnce};

/// The cycle from which on a plan can follow `p`, which itself may not have started.
std::int64_t earliest(const PublishedPlan& p, std::int64_t cycle) {
  return std::max(cycle, p.plan->start_cycle);
}

}  // namespace

struct Planner::Impl {
  PlannerModel model;
  const Interruption* interruption = nullptr;

  Route route;

  PublishedPlans plans;
  PlanningTime planning_time;
  FailedAttempt attempt;
  std::size_t law_attempt = 0;  ///< at the law of a window, of several
  bool stop_came_late = false;  ///< of the stops tried since the last command: the next is left the time it takes
  PathCommand wanted = PathCommand::Stop;
  double factor = 1;     ///< the override
  double limit_s = 0;    ///< path length at which RunOne ends
  double origin_mm = 0;  ///< of the forward path's length: so far behind the first one's
  bool rest_follows = false;

  Impl(PlannerModel m, PlanChannel& channel) : model(std::move(m)), route(model), plans(channel, model.period_s) {}

  [[nodiscard]] FeedRule feed(double override_factor) const { return {override_factor, model.max_feed_mm_s}; }
  [[nodiscard]] LaidPath& path() { return route.path(); }
  [[nodiscard]] const LaidPath& path() const { return route.path(); }
  [[nodiscard]] const PublishedPlan* base() const { return plans.base(); }
  [[nodiscard]] double now_s(const PublishedPlan& p, std::int64_t cycle) const { return plans.now_s(p, cycle); }
  /// The base is a plan on the path that is travelled, not one on the path before the last turn.
  [[nodiscard]] bool on_path() const { return base() != nullptr && base()->turns == route.turns(); }
  /// Where on the path that is travelled everything ends that is published.
  [[nodiscard]] double base_end_s() const {
    return on_path() ? base()->end_s() : route.turned_to().value_or(path().begin());
  }
  /// The place on `forward` where the machine stands at rest, or is to go on.
  [[nodiscard]] double place_s() const { return route.on_forward(base_end_s()); }

  [[nodiscard]] WindowEnd window_end(const PathState& from, double ramps) {
    const auto limit = wanted == PathCommand::RunOne && !route.on_detour() ? std::optional(limit_s) : std::nullopt;
    const WindowEnd end = next_window_end(path(), model.joints, from, ramps, factor, limit);
    if (end.in_work) planning_time.withdraw();
    return end;
  }

  bool publish(std::unique_ptr<Plan> plan, const WindowEnd& end, double window_begin, const Purpose& purpose = {}) {
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
    law_attempt = 0;
    return plans.publish(std::move(plan), std::move(about));
  }

  bool start_from_rest(const ServoProgress& progress) {
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

  /// Adds the next window to the plan that is followed: behind its end where the path demands rest there, else from its
  /// commit point.
  bool extend(const ServoProgress& progress) {
    const PublishedPlan& p = *base();
    const std::int64_t now = earliest(p, progress.cycle);
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

  /// Leaves the plan as soon as can be, for the window behind it or (s_stop given) to stop there.
  bool divert(const ServoProgress& progress, std::optional<double> s_stop) {
    const PublishedPlan& p = *base();
    const std::int64_t cycle = earliest(p, progress.cycle + planning_time.lead());
    const double t = now_s(p, cycle);
    const PathState from = p.state_at(t);
    const WindowEnd end = s_stop ? WindowEnd{*s_stop, false} : window_end(from, kRampsAtOnce);
    const double allowed = s_stop ? std::max(factor, p.override_factor) : factor;
    const bool same_feed = s_stop.has_value() || p.override_factor == factor;
    long work_left = kMostWorkOnLaw;
    auto law =
        plan_window(path().view(), model.joints, {from, end.s, feed(allowed), &p.law, same_feed, false, &work_left});
    if (!law) return false;
    return publish(go_on_as(p, cycle, t, *law, model.period_s), end, from.s, {s_stop.has_value(), 0});
  }

  /// Brakes as soon as can be, by a law that is found at once, before the path's next rest. `tries`: so often a better
  /// one is looked for afterwards, unless this one brakes as hard as can be from its begin on and is asked to stop.
  bool brake(const ServoProgress& progress, std::int64_t lead, double rest, Purpose purpose) {
    const PublishedPlan& p = *base();
    const std::int64_t cycle = earliest(p, progress.cycle + lead);
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

  /// A lowered override is answered by braking at once, from where a law for it goes on. A raised one is no hurry: what
  /// is planned keeps it; but where no law is found again and again, there is one from rest.
  bool follow_override(const ServoProgress& progress) {
    PublishedPlan& p = *plans.base();
    int& tries = p.purpose.better_tries;
    if (tries == 0) {
      const double rest = rest_behind(p, earliest(p, progress.cycle + PlanningTime::kShortestLead));
      const bool hurry = factor < p.override_factor || attempt.was_based_on(p.plan->id);
      if (hurry && brake(progress, PlanningTime::kShortestLead, rest, {false, kOverrideTries})) return true;
      tries = kOverrideTries;
      if (hurry) return false;
    }
    if (divert(progress, std::nullopt)) return true;
    --tries;
    return no_plan(progress, factor < p.override_factor ? kUrgent : FailedAttempt::kRetryAfter);
  }

  /// The next demanded rest on a plan that is followed, or its end, behind where it is in a cycle.
  [[nodiscard]] double rest_behind(const PublishedPlan& p, std::int64_t cycle) const {
    return path().next_rest(p.state_at(now_s(p, cycle)).s, base_end_s());
  }

  bool stop(const ServoProgress& progress) {
    // Of a plan that is not taken over yet, only what is the plan's before too is sure to be followed.
    const bool patient = stop_came_late && plans.acknowledged(progress);
    const std::int64_t lead = patient ? planning_time.lead() : PlanningTime::kShortestLead;
    // The rest ends every search: the plan itself comes to rest there.
    const double rest = rest_behind(*base(), earliest(*base(), progress.cycle + lead));
    return brake(progress, lead, rest, {true, kStopTries}) || end_at_rest(progress, rest);
  }

  /// Cuts the followed plan off at path length `rest`, where it stands still anyway.
  bool end_at_rest(const ServoProgress& progress, double rest) {
    const PublishedPlan& p = *base();
    if (rest >= base_end_s() - kSamePlace) {
      plans.base_stops(kStopTries);
      return true;
    }
    const std::int64_t now = earliest(p, progress.cycle);
    auto plan = go_on_as(p, now, p.time_at(rest - kSamePlace), {}, model.period_s);
    if (plan->law.empty()) return no_plan(progress);
    plans.go_on_from_base(*plan, progress);
    return publish(std::move(plan), {rest, true}, rest, {true, kStopTries});
  }

  [[nodiscard]] bool ends_sooner(const PromptLaw& found) const {
    const PublishedPlan& p = *base();
    const double end = found.law.back().at(found.law.back().duration).s, begin = p.state_at(found.leaves_t).s;
    return end < base_end_s() - kWorthIt * (base_end_s() - begin);
  }

  /// Looks for a stop that ends sooner than the one that is under way: one window a step.
  bool stop_sooner(const ServoProgress& progress) {
    PublishedPlan& p = *plans.base();
    const std::int64_t cycle = earliest(p, progress.cycle + planning_time.lead());
    const PathState from = p.state_at(now_s(p, cycle));
    const double shortest = from.v > 0 ? stop_distance(path().view(), model.joints, from) : 0;
    int& tries = p.purpose.better_tries;
    const std::size_t stretch = static_cast<std::size_t>(kStopTries - tries) % kStretches.size();
    const double s_end = from.s + shortest * kStretches[stretch];
    --tries;
    if (stretch == 0 && brake(progress, planning_time.lead(), rest_behind(p, cycle), {true, tries})) return true;
    if (from.v > 0 && s_end < base_end_s() - kWorthIt * (base_end_s() - from.s)) {
      if (divert(progress, s_end)) return true;
      if (stretch + 1 < kStretches.size()) return false;
    } else {
      tries -= static_cast<int>(kStretches.size() - 1 - stretch);  // the longer ones are no better
    }
    return no_plan(progress);
  }

  /// The law that was to begin a window was not found; there may be others to be tried, one a step.
  bool next_attempt(const ServoProgress& progress, std::size_t attempts) {
    if (gives_way()) return false;
    if (++law_attempt < attempts) return false;
    law_attempt = 0;
    return no_plan(progress);
  }

  bool no_plan(const ServoProgress& progress, std::int64_t retry_after = FailedAttempt::kRetryAfter) {
    if (gives_way()) return false;  // it was not tried to the end
    attempt.record(progress.cycle, base() == nullptr ? 0 : base()->plan->id, plans.ended(progress), retry_after);
    return false;
  }

  /// What there is to do, if anything; the order is the order of urgency.
  enum class Task { None, Stop, StopSooner, Turn, Override, Supply, Start, Extend };

  [[nodiscard]] Task task(const ServoProgress& progress) const {
    const bool known = plans.acknowledged(progress);
    if (!known && base()->plan->latest_cycle < progress.cycle + PlanningTime::kShortestLead) return Task::None;
    const bool at_end = plans.ended(progress);
    const bool this_way = route.retraces() == (wanted == PathCommand::Retrace);
    if (route.beside()) return Task::None;
    const bool run = wanted != PathCommand::Stop && factor > 0 && this_way;
    if (attempt.too_early(progress.cycle, at_end)) return Task::None;
    // A plan is left only once it is followed: what replaces it begins somewhere along it.
    const bool begun = base() == nullptr || progress.cycle >= base()->plan->start_cycle;
    if (!run && at_end) {
      const bool forward_again = route.retraces() && (wanted == PathCommand::Run || wanted == PathCommand::RunOne);
      return forward_again ? Task::Turn : Task::None;
    }
    if (!begun && !run) return Task::None;
    if (!run && base()->purpose.stops) return known && base()->purpose.better_tries > 0 ? Task::StopSooner : Task::None;
    if (!run) return Task::Stop;
    const bool one = wanted == PathCommand::RunOne && !route.on_detour();
    const double limit = one ? std::min(limit_s, path().end()) : path().end();
    const double planned_to = base_end_s();
    const bool rejoined = route.rejoins() && at_end && planned_to >= path().end() - kSamePlace;
    if (rejoined) return Task::Turn;
    const bool more = planned_to < limit - kSamePlace;
    const bool one_done = one && planned_to >= limit_s - kSamePlace;
    const bool dry = planned_to >= path().end() - kSamePlace && !one_done;
    if (dry && path().can_supply()) return Task::Supply;
    const PublishedPlan* const p = base();
    if (!known && !(factor < p->override_factor && p->purpose.better_tries == 0)) return Task::None;
    if (at_end || p == nullptr) {
      if (more) return Task::Start;
      return dry && path().has_more() && !path().gate.blocked() ? Task::Supply : Task::None;
    }
    if (p->purpose.stops) return Task::None;
    const double t_now = now_s(*p, progress.cycle);
    if (factor != p->override_factor || p->purpose.better_tries > 0) return begun ? Task::Override : Task::None;
    const double t_decide = p->hard_end ? p->plan->end_time_s : p->commit_t;
    if (more && t_decide - t_now < kHorizon_s) return Task::Extend;
    if (dry && path().has_more() && !path().gate.blocked() &&
        t_decide - t_now < kRelease_s + static_cast<double>(planning_time.lead()) * model.period_s)
      return Task::Supply;
    return Task::None;
  }

  /// Takes note of where the machine is. False while that is not known: a refused plan is still to come back through
  /// `retired`.
  bool follow(const ServoProgress& progress) {
    take_note_of(progress);
    if (plans.refused(progress)) stop_came_late = base()->purpose.stops;
    plans.collect();
    if (plans.refused(progress)) return false;
    if (!on_path() || !plans.acknowledged(progress)) return true;
    double s = base()->state_at(now_s(*base(), progress.cycle)).s;
    // What ends where the machine comes to rest is done when it rests, as the follower counts it.
    if (!plans.ended(progress)) s = std::min(s, base()->end_s() - 2 * kSamePlace);
    path().travelled(s, base()->law.front().start.s);
    if (route.on_detour() || s < kFarthest_mm) return true;
    const double by = std::floor(s);
    route.forward.move_origin(by);
    plans.move_origin(by);
    limit_s -= by;
    origin_mm += by;
    return true;
  }

  bool step(const ServoProgress& progress) {
    const bool known = follow(progress);
    route.forward.gate.wait_no_more();
    planning_time.learn(progress);
    if (!known) return false;
    // A plan that may still be refused has said of itself what there is to say.
    if (plans.acknowledged(progress)) {
      const PublishedPlan* const under_way = plans.ended(progress) ? nullptr : base();
      plans.tell_limit(horizon_limit(route, {wanted, factor, limit_s, rest_follows}, base_end_s(), under_way));
    }
    const Task next = task(progress);
    if (next != Task::None && next != Task::Supply && next != Task::Turn) {
      planning_time.begin(progress.cycle, next == Task::Stop && !stop_came_late);
    }
    switch (next) {
      case Task::None:
        return false;
      case Task::Stop:
        return stop(progress);
      case Task::Turn:
        route.turn_forward(base_end_s());
        if (wanted == PathCommand::RunOne) {
          const GivesWay to_nobody(nullptr);  // it lays path until the move's end is known
          limit_run();
        }
        return false;
      case Task::StopSooner:
        return stop_sooner(progress);
      case Task::Override:
        return follow_override(progress);
      case Task::Supply:
        if (!path().supply() && !path().can_supply()) path().release();
        return false;
      case Task::Start:
        return start_from_rest(progress);
      case Task::Extend:
        return extend(progress);
    }
    return false;
  }

  /// Sets RunOne's limit. After a retrace, the move that is run is the one not yet done.
  void limit_run() { limit_s = route.forward.next_move_end(std::max(place_s(), route.forward.farthest())); }

  /// Where on its path the follower left it, everything ends that was published.
  void take_note_of(const ServoProgress& progress) {
    const PathDeparture& last = progress.departure;
    if (last.count == plans.departures()) return;
    const PublishedPlan* const left = plans.find(last.plan);
    const double s = left == nullptr ? base_end_s() : left->state_at(now_s(*left, last.cycle)).s;
    if (!route.on_detour() && left != nullptr) route.forward.travelled(s, left->law.front().start.s);
    route.leave(s);
    plans.abandon(last);
    attempt.forget();
  }

  void command(PathCommand command) {
    if (command == PathCommand::RunOne) limit_run();
    if (command != wanted) {
      attempt.forget();
      stop_came_late = false;
    }
    wanted = command;
    plans.commanded(command == PathCommand::Stop);
  }

  void set_override(double percent) {
    const double wish = std::clamp(percent, 0.0, 200.0) / 100;
    if (wish != factor) attempt.forget();
    factor = wish;
  }
};

Planner::Planner(PlannerModel model, PlanChannel& channel) : impl_(std::make_unique<Impl>(std::move(model), channel)) {}
Planner::~Planner() = default;

void Planner::add(PathSegments segments) {
  impl_->route.forward.add(std::move(segments));
}

void Planner::clear() {
  impl_->route.clear(impl_->base_end_s());
}

Expected<double> Planner::turn_back(double distance_mm, std::span<const double> joints) {
  return impl_->route.turn_back(impl_->base_end_s(), distance_mm, {impl_->model, joints, kRejoinSpeed});
}
bool Planner::retraced(const ServoProgress& progress) const noexcept {
  const Impl& i = *impl_;
  if (i.wanted == PathCommand::Retrace && !i.route.retraces())
    return i.plans.ended(progress);  // a stop took it off its way
  return i.route.retraces() && i.plans.ended(progress) && i.base_end_s() >= i.path().end() - kSamePlace;
}
bool Planner::off_path() const noexcept {
  return impl_->route.beside();
}
double Planner::distance_to_path(std::span<const double> joints) const {
  return impl_->route.distance_to(joints);
}
Expected<> Planner::rejoin(std::span<const double> joints) {
  return impl_->route.rejoin({impl_->model, joints, kRejoinSpeed});
}
void Planner::give_way_to(const Interruption* interruption) noexcept {
  impl_->interruption = interruption;
}
void Planner::set_gate(PathGate* gate) noexcept {
  impl_->route.forward.gate.set(gate);
}
bool Planner::blocked() const noexcept {
  const Impl& i = *impl_;
  return !i.route.on_detour() && !i.route.beside() && i.path().gate.blocked() &&
         i.base_end_s() >= i.path().end() - kSamePlace;
}
bool Planner::waits_for_gate() const noexcept {
  return impl_->route.forward.gate.waits();
}
void Planner::command(PathCommand command) noexcept {
  impl_->command(command);
}
void Planner::set_override(double percent) noexcept {
  impl_->set_override(percent);
}
void Planner::rest_follows(bool follows) noexcept {
  impl_->rest_follows = follows;
}
void Planner::follow(const ServoProgress& progress) {
  (void)impl_->follow(progress);
}
bool Planner::step(const ServoProgress& progress) {
  const GivesWay now(impl_->interruption);
  return impl_->step(progress);
}
bool Planner::idle(const ServoProgress& progress) const noexcept {
  return impl_->task(progress) == Impl::Task::None;
}
bool Planner::at_rest(const ServoProgress& progress) const noexcept {
  return impl_->plans.ended(progress);
}
std::uint64_t Planner::lines_merged() const noexcept {
  return impl_->route.forward.lines_merged();
}

bool Planner::at_end() const noexcept {
  const Impl& i = *impl_;
  const bool elsewhere = i.route.on_detour() || i.route.beside();
  return !elsewhere && !i.path().has_more() && i.base_end_s() >= i.path().end() - kSamePlace;
}
std::size_t Planner::moves_left() const noexcept {
  return impl_->route.forward.moves_left();
}

std::optional<PathPlace> Planner::farthest_place() const {
  return impl_->route.forward.place_at(std::max(impl_->place_s(), impl_->route.forward.farthest()));
}

}  // namespace rmac
