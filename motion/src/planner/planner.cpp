#include "rmac/motion/planner.hpp"

#include <algorithm>
#include <cmath>

#include "gives_way.hpp"
#include "planner/horizon_limit.hpp"
#include "planner/planner_impl.hpp"

namespace rmac {
namespace {

/// Plans are made this far ahead of the servo loop; more would only be thrown away by a hold or an override.
constexpr double kHorizon_s = 0.4;
/// Path length is counted from a new origin once the tool is so far from the last: its rounding stays below 1e-12 mm.
constexpr double kFarthest_mm = 1000;
/// What is held back for the sake of a join is given out so long before the machine would have to brake for its lack.
constexpr double kRelease_s = 0.05;

}  // namespace

Planner::Impl::Task Planner::Impl::task(const ServoProgress& progress) const {
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

bool Planner::Impl::follow(const ServoProgress& progress) {
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

bool Planner::Impl::step(const ServoProgress& progress) {
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

void Planner::Impl::limit_run() {
  limit_s = route.forward.next_move_end(std::max(place_s(), route.forward.farthest()));
}

void Planner::Impl::take_note_of(const ServoProgress& progress) {
  const PathDeparture& last = progress.departure;
  if (last.count == plans.departures()) return;
  const PublishedPlan* const left = plans.find(last.plan);
  const double s = left == nullptr ? base_end_s() : left->state_at(now_s(*left, last.cycle)).s;
  if (!route.on_detour() && left != nullptr) route.forward.travelled(s, left->law.front().start.s);
  route.leave(s);
  plans.abandon(last);
  attempt.forget();
}

void Planner::Impl::command(PathCommand command) {
  if (command == PathCommand::RunOne) limit_run();
  if (command != wanted) {
    attempt.forget();
    stop_came_late = false;
  }
  wanted = command;
  plans.commanded(command == PathCommand::Stop);
}

void Planner::Impl::set_override(double percent) {
  const double wish = std::clamp(percent, 0.0, 200.0) / 100;
  if (wish != factor) {
    attempt.forget();
    leaving_attempt = 0;
  }
  factor = wish;
}

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
