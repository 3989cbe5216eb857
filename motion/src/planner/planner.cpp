#include "rmac/motion/planner.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "planner/failed_attempt.hpp"
#include "planner/next_window.hpp"
#include "planner/planning_time.hpp"
#include "planner/published_plan.hpp"
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

/// The cycle from which on a plan can follow `p`, which itself may not have started.
std::int64_t earliest(const PublishedPlan& p, std::int64_t cycle) {
  return std::max(cycle, p.plan->start_cycle);
}

}  // namespace

struct Planner::Impl {
  PlannerModel model;
  PlanChannel& channel;

  Route route;

  std::vector<PublishedPlan> alive;      ///< in order of publication; the last is the base of what is planned next
  std::vector<PublishedPlan> abandoned;  ///< when the path was left; still the follower's
  std::uint64_t departures = 0;          ///< of the path, that are known
  std::uint64_t next_id = 1;
  PlanningTime planning_time;
  FailedAttempt attempt;
  bool stop_came_late = false;  ///< of the stops tried since the last command: the next is left the time it takes
  PathCommand wanted = PathCommand::Stop;
  double factor = 1;     ///< the override
  double limit_s = 0;    ///< path length at which RunOne ends
  double origin_mm = 0;  ///< of the forward path's length: so far behind the first one's

  Impl(PlannerModel m, PlanChannel& c) : model(std::move(m)), channel(c), route(model) {}

  [[nodiscard]] FeedRule feed(double override_factor) const { return {override_factor, model.max_feed_mm_s}; }
  [[nodiscard]] LaidPath& path() { return route.path(); }
  [[nodiscard]] const LaidPath& path() const { return route.path(); }
  [[nodiscard]] double period() const { return model.period_s; }
  [[nodiscard]] const PublishedPlan* base() const { return alive.empty() ? nullptr : &alive.back(); }
  [[nodiscard]] double now_s(const PublishedPlan& p, std::int64_t cycle) const {
    return static_cast<double>(cycle - p.plan->start_cycle) * period();
  }
  /// A refused plan never acts; it is the base until it is collected.
  [[nodiscard]] bool refused(const ServoProgress& progress) const {
    return base() != nullptr && progress.last_refused == base()->plan->id;
  }
  [[nodiscard]] bool acknowledged(const ServoProgress& progress) const {
    return base() == nullptr || progress.accepted_plan >= base()->plan->id || refused(progress);
  }
  [[nodiscard]] bool ended(const ServoProgress& progress) const {
    if (base() == nullptr) return true;
    return acknowledged(progress) && !refused(progress) && now_s(*base(), progress.cycle) >= base()->plan->end_time_s;
  }
  /// The base is a plan on the path that is travelled, not one on the path before the last turn.
  [[nodiscard]] bool on_path() const { return base() != nullptr && base()->turns == route.turns(); }
  /// Where on the path that is travelled everything ends that is published.
  [[nodiscard]] double base_end_s() const {
    return on_path() ? base()->end_s() : route.turned_to().value_or(path().begin());
  }
  /// The place on `forward` where the machine stands at rest, or is to go on.
  [[nodiscard]] double place_s() const { return route.on_forward(base_end_s()); }

  void collect(const ServoProgress& progress) {
    const Plan* plan = nullptr;
    while (channel.retired.pop(plan)) {
      for (auto* plans : {&alive, &abandoned}) {
        std::erase_if(*plans, [&](const PublishedPlan& p) { return p.plan.get() == plan; });
      }
    }
    planning_time.learn(progress);
  }

  [[nodiscard]] WindowEnd window_end(double s, double ramps) {
    const auto limit = wanted == PathCommand::RunOne && !route.on_detour() ? std::optional(limit_s) : std::nullopt;
    return next_window_end(path(), model.joints, s, ramps, factor, limit);
  }

  bool publish(std::unique_ptr<Plan> plan, bool stops, const WindowEnd& end, double window_begin) {
    plan->id = next_id;
    plan->origin_mm = origin_mm;
    plan->departures = departures;
    const LawPiece& last = plan->law.back();
    plan->end_time_s = last.t0 + last.duration;
    const double s_begin = plan->law.front().start.s, s_end = last.at(last.duration).s;
    const PathView view = path().view();
    // The cycle before may have seen the segment before, whose end the follower still has to count.
    const double s_before = s_begin - 2 * plan->law.front().start.v * period();
    for (std::size_t i = view.find(s_before, 1); i <= view.find(s_end, -1); ++i) {
      plan->segments.push_back(path().segment(i));
      plan->segment_start.push_back(path().start(i));
    }
    PublishedPlan p;
    p.stops = stops;
    p.hard_end = end.hard;
    p.turns = route.turns();
    p.override_factor = factor;
    p.commit_t = commit_time(*plan, window_begin, end.planned_again);
    p.law = plan->law;
    p.plan = std::move(plan);
    if (!channel.published.push(p.plan.get()))
      return false;  // the servo loop does not take plans: it stands still or is gone
    ++next_id;
    alive.push_back(std::move(p));
    if (stops) channel.stopping.store(alive.back().plan->id, std::memory_order_release);
    return true;
  }

  bool start_from_rest(const ServoProgress& progress) {
    const double s = base_end_s();
    WindowEnd end = window_end(s, kRampsAtOnce);
    auto law = law_from_rest(path().view(), model.joints, s, end, feed(factor));
    if (!law) return no_plan(progress);
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = progress.cycle + planning_time.lead();
    plan->latest_cycle = plan->start_cycle;
    plan->law = std::move(*law);
    return publish(std::move(plan), false, end, s);
  }

  /// Adds the next window to the plan that is followed: behind its end where the path demands rest there, else from its
  /// commit point.
  bool extend(const ServoProgress& progress) {
    const PublishedPlan& p = *base();
    const std::int64_t now = earliest(p, progress.cycle);
    const double t_now = now_s(p, now);
    const double t_soonest = t_now + static_cast<double>(planning_time.lead()) * period();
    // Too near the end to be there in time: the machine comes to rest, and starts again from there.
    if (t_soonest > p.plan->end_time_s) return no_plan(progress);
    double t_from = p.plan->end_time_s;
    // A state from which no window was found is not asked again: the next attempt is from a sooner one.
    if (!p.hard_end) t_from = std::clamp(attempt.was_based_on(p.plan->id) ? t_soonest : p.commit_t, t_soonest, t_from);
    const PathState from = p.state_at(t_from);
    WindowEnd end;
    std::optional<std::vector<LawPiece>> law;
    if (from.v == 0 && from.a == 0) {
      end = window_end(from.s, kRampsAtOnce);
      law = law_from_rest(path().view(), model.joints, from.s, end, feed(factor));
    } else {
      for (const double ramps : {kRampsAhead, kRampsAtOnce}) {
        end = window_end(from.s, ramps);
        law = plan_window(path().view(), model.joints, {from, end.s, feed(factor), &p.law, true, true});
        if (law) break;
      }
    }
    if (!law) return no_plan(progress);
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = now;
    plan->law = p.pieces_between(t_now, t_from);
    plan->latest_cycle = now + static_cast<std::int64_t>(std::floor((t_from - t_now) / period() + 1e-9));
    append_law(plan->law, *law, t_from - t_now);
    return publish(std::move(plan), false, end, from.s);
  }

  /// Leaves the plan in `cycle`: for a new override, or (s_stop given) to stop there.
  bool divert(std::int64_t cycle, std::optional<double> s_stop) {
    const PublishedPlan& p = *base();
    const PathState from = p.state_at(now_s(p, cycle));
    const WindowEnd end = s_stop ? WindowEnd{*s_stop, false} : window_end(from.s, kRampsAtOnce);
    const double allowed = s_stop ? std::max(factor, p.override_factor) : factor;
    auto law = plan_window(path().view(), model.joints, {from, end.s, feed(allowed), &p.law, s_stop.has_value()});
    if (!law) return false;
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = cycle;
    plan->latest_cycle = cycle;
    plan->law = std::move(*law);
    return publish(std::move(plan), s_stop.has_value(), end, from.s);
  }

  bool stop(const ServoProgress& progress) {
    const PublishedPlan& p = *base();
    const std::int64_t lead = stop_came_late ? planning_time.lead() : PlanningTime::kShortestLead;
    const std::int64_t cycle = earliest(p, progress.cycle + lead);
    const PathState from = p.state_at(now_s(p, cycle));
    if (from.v <= 0) return no_plan(progress);
    const double shortest = stop_distance(path().view(), model.joints, from);
    // The next demanded rest on the followed plan ends every search: the plan itself comes to rest there.
    const double rest = path().next_rest(from.s, base_end_s());
    for (const double stretch : {1.02, 1.08, 1.2, 1.4, 1.8, 2.5, 4.0, 7.0}) {
      const double s_end = from.s + shortest * stretch;
      if (s_end >= rest - kSamePlace) return end_at_rest(progress, rest);
      if (divert(cycle, s_end)) return true;
    }
    // This state, at the edge of what the limits allow, has no way out but the plan's own; one a little later may.
    return no_plan(progress);
  }

  /// Cuts the followed plan off at path length `rest`, where it stands still anyway.
  bool end_at_rest(const ServoProgress& progress, double rest) {
    const PublishedPlan& p = *base();
    if (rest >= base_end_s() - kSamePlace) {
      alive.back().stops = true;
      channel.stopping.store(alive.back().plan->id, std::memory_order_release);
      return true;
    }
    const double t_rest = p.time_at(rest - kSamePlace);
    auto plan = std::make_unique<Plan>();
    const std::int64_t now = earliest(p, progress.cycle);
    const double t_now = now_s(p, now);
    plan->start_cycle = now;
    plan->law = p.pieces_between(t_now, t_rest);
    plan->latest_cycle = now + static_cast<std::int64_t>(std::floor((t_rest - t_now) / period()));
    if (plan->law.empty()) return no_plan(progress);
    return publish(std::move(plan), true, {rest, true}, rest);
  }

  /// The machine has come to path length s.
  void travelled(double s) {
    path().travelled(s, base()->law.front().start.s);
    if (route.on_detour() || s < kFarthest_mm) return;
    const double by = std::floor(s);
    route.forward.move_origin(by);
    for (PublishedPlan& p : alive) p.move_origin(by);
    limit_s -= by;
    origin_mm += by;
  }

  bool no_plan(const ServoProgress& progress) {
    attempt.record(progress.cycle, base() == nullptr ? 0 : base()->plan->id, ended(progress));
    return false;
  }

  /// What there is to do, if anything; the order is the order of urgency.
  enum class Task { None, Stop, Turn, Override, Supply, Start, Extend };

  [[nodiscard]] Task task(const ServoProgress& progress) const {
    if (!acknowledged(progress)) return Task::None;
    const bool at_end = ended(progress);
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
    if (!run) return base()->stops || !begun ? Task::None : Task::Stop;
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
    if (at_end || p == nullptr) {
      if (more) return Task::Start;
      return dry && path().has_more() ? Task::Supply : Task::None;
    }
    if (p->stops) return Task::None;
    const double t_now = now_s(*p, progress.cycle);
    if (factor != p->override_factor) return begun ? Task::Override : Task::None;
    const double t_decide = p->hard_end ? p->plan->end_time_s : p->commit_t;
    if (more && t_decide - t_now < kHorizon_s) return Task::Extend;
    if (dry && path().has_more() &&
        t_decide - t_now < kRelease_s + static_cast<double>(planning_time.lead()) * period())
      return Task::Supply;
    return Task::None;
  }

  bool step(const ServoProgress& progress) {
    take_note_of(progress);
    if (refused(progress)) stop_came_late = base()->stops;
    collect(progress);
    if (refused(progress)) return false;  // it is still to come back through `retired`
    if (on_path() && acknowledged(progress)) travelled(base()->state_at(now_s(*base(), progress.cycle)).s);
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
        if (wanted == PathCommand::RunOne) limit_run();
        return false;
      case Task::Override:
        return divert(earliest(*base(), progress.cycle + planning_time.lead()), std::nullopt) || no_plan(progress);
      case Task::Supply:
        if (!path().supply()) path().release();
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
    if (last.count == departures) return;
    departures = last.count;
    const auto left =
        std::find_if(alive.begin(), alive.end(), [&](const PublishedPlan& p) { return p.plan->id == last.plan; });
    const double s = left == alive.end() ? base_end_s() : left->state_at(now_s(*left, last.cycle)).s;
    if (!route.on_detour() && left != alive.end()) route.forward.travelled(s, left->law.front().start.s);
    route.leave(s);
    std::move(alive.begin(), alive.end(), std::back_inserter(abandoned));
    alive.clear();
    attempt.forget();
  }

  void command(PathCommand command) {
    if (command == PathCommand::RunOne) limit_run();
    if (command != wanted) {
      attempt.forget();
      stop_came_late = false;
    }
    wanted = command;
    // A stop that is under way still, though something else was commanded meanwhile, is the one that is asked for.
    const bool stops = command == PathCommand::Stop && base() != nullptr && base()->stops;
    channel.stopping.store(stops ? base()->plan->id : 0, std::memory_order_release);
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
  if (i.wanted == PathCommand::Retrace && !i.route.retraces()) return i.ended(progress);  // a stop took it off its way
  return i.route.retraces() && i.ended(progress) && i.base_end_s() >= i.path().end() - kSamePlace;
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
void Planner::command(PathCommand command) noexcept {
  impl_->command(command);
}
void Planner::set_override(double percent) noexcept {
  impl_->set_override(percent);
}
bool Planner::step(const ServoProgress& progress) {
  return impl_->step(progress);
}
bool Planner::idle(const ServoProgress& progress) const noexcept {
  return impl_->task(progress) == Impl::Task::None;
}
bool Planner::at_rest(const ServoProgress& progress) const noexcept {
  return impl_->ended(progress);
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
