#include "rmac/motion/planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "joins/path_joiner.hpp"
#include "path/join.hpp"
#include "time_law/window.hpp"

namespace rmac {
namespace {

/// Plans are made this far ahead of the servo loop; more would only be thrown away by a hold or an override.
constexpr double kHorizon_s = 0.4;
/// A window holds this many ramps to full speed, of which the part `kCommitted` is kept when the next window is
/// planned.
constexpr double kRampsInWindow = 5;
constexpr double kCommitted = 0.6;
constexpr double kShortestWindow_mm = 1.0;
constexpr std::int64_t kLeadAtFirst = 2;
constexpr std::int64_t kLongestLead = 64;
constexpr double kSamePlace = 1e-7;
/// A window that found no plan is tried again from a later state, after so many cycles.
constexpr std::int64_t kRetryAfter = 10;
/// What is held back for the sake of a join is given out so long before the machine would have to brake for its lack.
constexpr double kRelease_s = 0.05;

}  // namespace

/// A published plan with what the planner must remember of it.
struct PublishedPlan {
  std::unique_ptr<const Plan> plan;
  bool stops = false;     ///< made to stop: the path goes on behind its end, but motion does not
  bool hard_end = false;  ///< it ends where the path demands rest
  double override_factor = 1;
  double commit_t = 0;  ///< time of the plan up to which a following window keeps it
};

struct Planner::Impl {
  PlannerModel model;
  PlanChannel& channel;

  std::vector<std::shared_ptr<const PathSegment>> segments;
  std::vector<double> starts;
  std::vector<char> rest_after;  ///< the path demands rest at the end of this segment
  PathJoiner joiner;
  std::size_t moves_left = 0;
  double origin = 0;  ///< path length at which the first segment begins

  std::vector<PublishedPlan> alive;  ///< in order of publication; the last is the base of what is planned next
  std::uint64_t next_id = 1;
  std::uint64_t refused_seen = 0;
  double work_cycles = 0;                ///< cycles that went by while a plan was made, lately
  std::int64_t work_began = -1;          ///< cycle in which the last plan was begun
  std::int64_t tried_at = -kRetryAfter;  ///< cycle of the last attempt that found no plan
  bool tried_from_rest = false;
  PathCommand wanted = PathCommand::Stop;
  double factor = 1;   ///< the override
  double limit_s = 0;  ///< path length at which RunOne ends

  Impl(PlannerModel m, PlanChannel& c) : model(std::move(m)), channel(c), joiner(model.joints, model.period_s) {}

  [[nodiscard]] FeedRule feed(double override_factor) const { return {override_factor, model.max_feed_mm_s}; }
  [[nodiscard]] double period() const { return model.period_s; }
  [[nodiscard]] double path_end() const {
    return segments.empty() ? origin : starts.back() + segments.back()->length();
  }
  [[nodiscard]] PublishedPlan* base() { return alive.empty() ? nullptr : &alive.back(); }
  [[nodiscard]] const PublishedPlan* base() const { return alive.empty() ? nullptr : &alive.back(); }
  [[nodiscard]] double now_s(const PublishedPlan& p, std::int64_t cycle) const {
    return static_cast<double>(cycle - p.plan->start_cycle) * period();
  }
  [[nodiscard]] bool acknowledged(const ServoProgress& progress) const {
    return base() == nullptr || progress.accepted_plan >= base()->plan->id || progress.last_refused == base()->plan->id;
  }
  [[nodiscard]] bool ended(const ServoProgress& progress) const {
    return base() == nullptr || (acknowledged(progress) && now_s(*base(), progress.cycle) >= base()->plan->end_time_s);
  }
  [[nodiscard]] double base_end_s() const {
    if (base() == nullptr) return origin;
    const LawPiece& last = base()->plan->law.back();
    return last.at(last.duration).s;
  }

  void add(std::vector<std::shared_ptr<const PathSegment>> added) {
    for (auto& segment : added) {
      moves_left += segment->moves_ended(-1, segment->length());
      joiner.add(std::move(segment));
    }
  }

  /// Lays what comes out of the joiner onto the path.
  void lay(const PathJoiner::Segments& fresh) {
    for (const auto& segment : fresh) {
      if (!segments.empty()) rest_after.back() = static_cast<char>(demands_rest(*segments.back(), *segment));
      starts.push_back(path_end());
      segments.push_back(segment);
      rest_after.push_back(static_cast<char>(segment->demand().rest_after));
    }
  }

  /// Makes the path longer by what is certain; false when nothing is.
  bool supply() {
    PathJoiner::Segments fresh;
    while (fresh.empty() && joiner.ready()) joiner.advance(fresh);
    lay(fresh);
    return !fresh.empty();
  }

  /// Makes the path longer by what was held back for a join.
  void release() {
    PathJoiner::Segments fresh;
    joiner.release(fresh);
    lay(fresh);
  }

  [[nodiscard]] bool demands_rest(const PathSegment& before, const PathSegment& after) const {
    if (before.demand().rest_after || after.demand().rest_before) return true;
    if (before.curve().in_joint_space() != after.curve().in_joint_space()) return true;
    JointPoint below, above;
    if (before.evaluate(before.length(), 2, -1, below) != KinematicsStatus::Ok ||
        after.evaluate(0, 2, 1, above) != KinematicsStatus::Ok)
      return true;
    return !passable(below, above, model.joints, std::max({before.demand().feed_mm_s, after.demand().feed_mm_s, 1.0}),
                     period());
  }

  /// Cycles from now after which a plan begun now will have reached the servo loop.
  [[nodiscard]] std::int64_t lead() const { return kLeadAtFirst + static_cast<std::int64_t>(std::ceil(work_cycles)); }

  /// The cycle from which on a plan can follow `p`, which itself may not have started.
  [[nodiscard]] static std::int64_t earliest(const PublishedPlan& p, std::int64_t cycle) {
    return std::max(cycle, p.plan->start_cycle);
  }

  void collect(const ServoProgress& progress) {
    const Plan* plan = nullptr;
    while (channel.retired.pop(plan)) {
      std::erase_if(alive, [&](const PublishedPlan& p) { return p.plan.get() == plan; });
    }
    // A refused plan never acted: `alive` ends again with the plan that is followed. The next attempt leaves more time.
    if (work_began >= 0) {
      work_cycles = std::max(0.9 * work_cycles, static_cast<double>(progress.cycle - work_began - 1));
      work_began = -1;
    }
    if (progress.last_refused != refused_seen) {
      refused_seen = progress.last_refused;
      work_cycles = 2 * work_cycles + 1;
    }
    work_cycles = std::min(work_cycles, static_cast<double>(kLongestLead));
  }

  /// Drops segments that are behind the tool.
  void forget_travelled(double s) {
    std::size_t behind = 0;
    while (behind + 1 < segments.size() && starts[behind + 1] <= s - kSamePlace) ++behind;
    if (behind < 256 && behind * 2 < segments.size()) return;
    const auto n = static_cast<std::ptrdiff_t>(behind);
    segments.erase(segments.begin(), segments.begin() + n);
    starts.erase(starts.begin(), starts.begin() + n);
    rest_after.erase(rest_after.begin(), rest_after.begin() + n);
  }

  [[nodiscard]] PathState state_at(const PublishedPlan& p, double t) const {
    const auto& law = p.plan->law;
    if (t >= p.plan->end_time_s) return {law.back().at(law.back().duration).s, 0, 0};
    auto piece =
        std::upper_bound(law.begin(), law.end(), t, [](double value, const LawPiece& x) { return value < x.t0; });
    if (piece != law.begin()) --piece;
    return piece->at(std::max(t - piece->t0, 0.0));
  }

  /// Where the window that begins at s must or may end: at a demanded rest, at RunOne's limit, at the end of the path,
  /// or where it is long enough. `hard` tells the first two.
  [[nodiscard]] double window_end(double s, const PathView& path, bool& hard) {
    hard = false;
    std::optional<double> found;
    double v = 0, reach = kShortestWindow_mm;
    double a = std::numeric_limits<double>::infinity(), j = a;
    for (const JointLimits& joint : model.joints)
      a = std::min(a, joint.max_acceleration), j = std::min(j, joint.max_jerk);
    double fastest = 0;
    for (const JointLimits& joint : model.joints) fastest = std::max(fastest, joint.max_speed);
    for (std::size_t i = path.find(s + kSamePlace, 1); i < segments.size() || supply(); ++i) {
      v = std::max(v, std::min(segments[i]->demand().feed_mm_s * std::max(factor, 1.0), 2 * fastest));
      reach = std::max(reach, kRampsInWindow * ramp_length(v, a, j));
      const double end = starts[i] + segments[i]->length();
      // Whether the path goes on without rest is known once its next segment is there.
      if (i + 1 == segments.size() && rest_after[i] == 0 && end - s <= 2 * reach) supply();
      if (rest_after[i] != 0) {
        found = end;
        hard = true;
        break;
      }
      if (end - s > 2 * reach) {
        found = end;
        break;
      }
    }
    double stop = found.value_or(path_end());
    if (wanted == PathCommand::RunOne && limit_s <= stop) {
      stop = limit_s;
      hard = true;
    }
    if (stop - s > 1.5 * reach) {
      hard = false;
      return s + reach;
    }
    return stop;
  }

  bool publish(std::unique_ptr<Plan> plan, bool stops, bool hard_end, double committed_from) {
    plan->id = next_id;
    const LawPiece& last = plan->law.back();
    plan->end_time_s = last.t0 + last.duration;
    const double s_begin = plan->law.front().start.s, s_end = last.at(last.duration).s;
    const PathView path(segments, starts);
    // The cycle before may have seen the segment before, whose end the follower still has to count.
    const double s_before = s_begin - 2 * plan->law.front().start.v * period();
    for (std::size_t i = path.find(s_before, 1); i <= path.find(s_end, -1); ++i) {
      plan->segments.push_back(segments[i]);
      plan->segment_start.push_back(starts[i]);
    }
    PublishedPlan p;
    p.stops = stops;
    p.hard_end = hard_end;
    p.override_factor = factor;
    p.commit_t = commit_time(*plan, committed_from);
    p.plan = std::move(plan);
    if (!channel.published.push(p.plan.get()))
      return false;  // the servo loop does not take plans: it stands still or is gone
    ++next_id;
    alive.push_back(std::move(p));
    return true;
  }

  /// The time up to which a plan is kept when more path comes: before it brakes for its own end, and not all of its
  /// last window.
  [[nodiscard]] double commit_time(const Plan& plan, double committed_from) const {
    const auto& law = plan.law;
    const LawPiece& last = law.back();
    const double s_end = last.at(last.duration).s;
    const double s_commit = committed_from + kCommitted * (s_end - committed_from);
    double t = plan.end_time_s;
    for (std::size_t i = law.size(); i-- > 0;) {
      t = law[i].t0;
      const bool braking = law[i].start.a < 0 && law[i].at(law[i].duration).a <= 0;
      if (law[i].start.s <= s_commit ||
          (!braking && i + 1 < law.size() && law[i].kind == LawPiece::Kind::Linear && law[i].start.s <= s_commit))
        break;
    }
    return t;
  }

  /// Law pieces of `p` from the cycle's time on until t_end, with times counted from `cycle`.
  [[nodiscard]] std::vector<LawPiece> kept_pieces(const PublishedPlan& p, std::int64_t cycle, double t_end) const {
    std::vector<LawPiece> kept;
    const double t_now = now_s(p, cycle);
    for (LawPiece piece : p.plan->law) {
      const double end = piece.t0 + piece.duration;
      if (end <= t_now || piece.t0 >= t_end) continue;
      if (end > t_end) piece.duration = t_end - piece.t0;
      piece.t0 -= t_now;
      kept.push_back(piece);
    }
    return kept;
  }

  static void append_law(std::vector<LawPiece>& law, const std::vector<LawPiece>& tail, double t0) {
    for (LawPiece piece : tail) {
      piece.t0 += t0;
      law.push_back(piece);
    }
  }

  /// The law of a window from rest, which may end earlier than asked (`hard` is then cleared): what is too much for one
  /// window may be found in parts, and where nothing is found the cautious law creeps over a short part only.
  [[nodiscard]] std::optional<std::vector<LawPiece>> law_from_rest(double s, double s_end, bool& hard) const {
    const PathView path(segments, starts);
    if (auto law = plan_window(path, model.joints, {{s, 0, 0}, s_end, feed(factor), nullptr})) return law;
    for (const double part : {0.5, 0.4, 0.35, 0.3}) {
      const double end = s + part * (s_end - s);
      if (end - s < 100 * kSamePlace) break;
      hard = false;
      if (auto law = plan_window(path, model.joints, {{s, 0, 0}, end, feed(factor), nullptr})) return law;
      s_end = end;
    }
    auto law = cautious_law(path, model.joints, s, s_end, feed(factor));
    if (check_law(path, model.joints, law, nullptr).worst <= 1.0) return law;
    return std::nullopt;
  }

  bool start_from_rest(const ServoProgress& progress) {
    const PathView path(segments, starts);
    const double s = base_end_s();
    bool hard = false;
    const double s_end = window_end(s, path, hard);
    auto law = law_from_rest(s, s_end, hard);
    if (!law) return no_plan(progress);
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = progress.cycle + lead();
    plan->latest_cycle = plan->start_cycle;
    plan->law = std::move(*law);
    return publish(std::move(plan), false, hard, s);
  }

  /// Adds the next window to the plan that is followed: behind its end where the path demands rest there, else from its
  /// commit point.
  bool extend(const ServoProgress& progress) {
    const PathView path(segments, starts);
    const PublishedPlan& p = *base();
    const std::int64_t now = earliest(p, progress.cycle);
    const double t_now = now_s(p, now);
    double t_from = p.plan->end_time_s;
    if (!p.hard_end) t_from = std::min(std::max(p.commit_t, t_now + static_cast<double>(lead()) * period()), t_from);
    // Too near the end to be there in time: the machine comes to rest, and starts again from there.
    if (t_from - t_now < static_cast<double>(lead()) * period()) return no_plan(progress);
    const PathState from = state_at(p, t_from);
    bool hard = false;
    const double s_end = window_end(from.s, path, hard);
    auto law = from.v == 0 && from.a == 0 ? law_from_rest(from.s, s_end, hard)
                                          : plan_window(path, model.joints, {from, s_end, feed(factor), &p.plan->law});
    if (!law) return no_plan(progress);
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = now;
    plan->law = kept_pieces(p, now, t_from);
    plan->latest_cycle = now + static_cast<std::int64_t>(std::floor((t_from - t_now) / period() + 1e-9));
    append_law(plan->law, *law, t_from - t_now);
    return publish(std::move(plan), false, hard, from.s);
  }

  /// Leaves the plan `lead()` cycles from now: for a new override, or (s_end given) to stop there.
  bool divert(const ServoProgress& progress, std::optional<double> s_end, bool stops) {
    const PathView path(segments, starts);
    const PublishedPlan& p = *base();
    const std::int64_t cycle = earliest(p, progress.cycle + lead());
    const PathState from = state_at(p, now_s(p, cycle));
    bool hard = false;
    const double end = s_end ? *s_end : window_end(from.s, path, hard);
    auto law = plan_window(path, model.joints,
                           {from, end, feed(stops ? std::max(factor, p.override_factor) : factor), &p.plan->law});
    if (!law) return false;
    auto plan = std::make_unique<Plan>();
    plan->start_cycle = cycle;
    plan->latest_cycle = cycle;
    plan->law = std::move(*law);
    return publish(std::move(plan), stops, hard, from.s);
  }

  bool stop(const ServoProgress& progress) {
    const PublishedPlan& p = *base();
    const PathState from = state_at(p, now_s(p, earliest(p, progress.cycle + lead())));
    if (from.v <= 0) return no_plan(progress);
    // The next demanded rest on the followed plan ends every search: the plan itself comes to rest there.
    double rest = base_end_s();
    const PathView path(segments, starts);
    for (std::size_t i = path.find(from.s, 1); i < segments.size(); ++i) {
      if (rest_after[i] != 0) {
        rest = std::min(rest, starts[i] + segments[i]->length());
        break;
      }
    }
    double a = std::numeric_limits<double>::infinity(), j = a;
    JointPoint point;
    if (path.evaluate(from.s, 1, 1, point) != KinematicsStatus::Ok) return no_plan(progress);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
      const double d = std::max(std::abs(point.d[1][k]), 1e-9);
      a = std::min(a, model.joints[k].max_acceleration / d);
      j = std::min(j, model.joints[k].max_jerk / d);
    }
    // First the acceleration has to be taken back to zero; then a ramp down.
    const double t0 = std::max(from.a, 0.0) / j;
    const double v_top = from.v + 0.5 * std::max(from.a, 0.0) * t0;
    const double shortest = from.v * t0 + from.a * t0 * t0 / 3 + ramp_length(v_top, a, j);
    for (const double stretch : {1.02, 1.08, 1.2, 1.4, 1.8, 2.5, 4.0}) {
      const double s_end = from.s + shortest * stretch;
      if (s_end >= rest - kSamePlace) return end_at_rest(progress, rest);
      if (divert(progress, s_end, true)) return true;
    }
    // This state, at the edge of what the limits allow, has no way out but the plan's own; one a little later may.
    return no_plan(progress);
  }

  /// Cuts the followed plan off at path length `rest`, where it stands still anyway.
  bool end_at_rest(const ServoProgress& progress, double rest) {
    const PublishedPlan& p = *base();
    if (rest >= base_end_s() - kSamePlace) {
      base()->stops = true;
      return true;
    }
    double t_rest = p.plan->end_time_s;
    for (const LawPiece& piece : p.plan->law) {
      if (piece.start.s >= rest - kSamePlace) {
        t_rest = piece.t0;
        break;
      }
    }
    auto plan = std::make_unique<Plan>();
    const std::int64_t now = earliest(p, progress.cycle);
    const double t_now = now_s(p, now);
    plan->start_cycle = now;
    plan->law = kept_pieces(p, now, t_rest);
    plan->latest_cycle = now + static_cast<std::int64_t>(std::floor((t_rest - t_now) / period()));
    if (plan->law.empty()) return no_plan(progress);
    return publish(std::move(plan), true, true, rest);
  }

  bool no_plan(const ServoProgress& progress) {
    tried_at = progress.cycle;
    tried_from_rest = ended(progress);
    return false;
  }

  /// What there is to do, if anything; the order is the order of urgency.
  enum class Task { None, Stop, Override, Supply, Start, Extend };

  [[nodiscard]] Task task(const ServoProgress& progress) const {
    if (!acknowledged(progress)) return Task::None;
    const bool at_end = ended(progress);
    // What found no plan in motion may find one from rest.
    if (progress.cycle < tried_at + kRetryAfter && tried_from_rest == at_end) return Task::None;
    const bool run = wanted != PathCommand::Stop && factor > 0;
    // A plan is left only once it is followed: what replaces it begins somewhere along it.
    const bool begun = base() == nullptr || progress.cycle >= base()->plan->start_cycle;
    if (!run) return at_end || base()->stops || !begun ? Task::None : Task::Stop;
    const double limit = wanted == PathCommand::RunOne ? std::min(limit_s, path_end()) : path_end();
    const bool more = base_end_s() < limit - kSamePlace;
    const bool one_done = wanted == PathCommand::RunOne && base_end_s() >= limit_s - kSamePlace;
    const bool dry = base_end_s() >= path_end() - kSamePlace && !one_done;
    if (dry && joiner.ready()) return Task::Supply;
    if (at_end) {
      if (more) return Task::Start;
      return dry && !joiner.empty() ? Task::Supply : Task::None;
    }
    if (base()->stops) return Task::None;
    const double t_now = now_s(*base(), progress.cycle);
    if (factor != base()->override_factor) return begun ? Task::Override : Task::None;
    const double t_decide = base()->hard_end ? base()->plan->end_time_s : base()->commit_t;
    if (more && t_decide - t_now < kHorizon_s) return Task::Extend;
    if (dry && !joiner.empty() && t_decide - t_now < kRelease_s + static_cast<double>(lead()) * period())
      return Task::Supply;
    return Task::None;
  }

  bool step(const ServoProgress& progress) {
    collect(progress);
    if (base() != nullptr && acknowledged(progress) && progress.last_refused == base()->plan->id)
      return false;  // comes back through `retired`
    if (base() != nullptr && acknowledged(progress)) {
      const double s = state_at(*base(), now_s(*base(), progress.cycle)).s;
      count_done(s);
      forget_travelled(std::min(s, base()->plan->law.front().start.s));
    }
    const Task next = task(progress);
    if (next != Task::None && next != Task::Supply) work_began = progress.cycle;
    switch (next) {
      case Task::None:
        return false;
      case Task::Stop:
        return stop(progress);
      case Task::Override:
        return divert(progress, std::nullopt, false) || no_plan(progress);
      case Task::Supply:
        if (!supply()) release();
        return false;
      case Task::Start:
        return start_from_rest(progress);
      case Task::Extend:
        return extend(progress);
    }
    return false;
  }

  double counted_s = -std::numeric_limits<double>::infinity();

  void count_done(double s) {
    for (std::size_t i = 0; i < segments.size() && starts[i] <= s; ++i) {
      const std::size_t done = segments[i]->moves_ended(counted_s + kSamePlace - starts[i], s + kSamePlace - starts[i]);
      moves_left -= std::min(moves_left, done);
    }
    counted_s = std::max(counted_s, s);
  }

  /// Where the move ends that the machine is in, or stands before.
  [[nodiscard]] double next_move_end(double s) {
    for (std::size_t i = segments.empty() ? 0 : PathView(segments, starts).find(s + kSamePlace, 1);; ++i) {
      while (i >= segments.size() && !joiner.empty()) {
        if (!supply()) release();
      }
      if (i >= segments.size()) return path_end();
      const auto stretches = segments[i]->stretches();
      for (std::size_t k = 0; k < stretches.size(); ++k) {
        const double end = starts[i] + (k + 1 < stretches.size() ? stretches[k + 1].begin : segments[i]->length());
        if (stretches[k].last_of_move && end > s + kSamePlace) return end;
      }
    }
  }

  void command(PathCommand command) {
    if (command == PathCommand::RunOne) limit_s = next_move_end(base_end_s());
    if (command != wanted) tried_at = -kRetryAfter;  // what failed was another wish
    wanted = command;
  }

  void set_override(double percent) {
    const double wish = std::clamp(percent, 0.0, 200.0) / 100;
    if (wish != factor) tried_at = -kRetryAfter;
    factor = wish;
  }
};

Planner::Planner(PlannerModel model, PlanChannel& channel) : impl_(std::make_unique<Impl>(std::move(model), channel)) {}
Planner::~Planner() = default;

void Planner::add(std::vector<std::shared_ptr<const PathSegment>> segments) {
  impl_->add(std::move(segments));
}

void Planner::clear() {
  Impl& i = *impl_;
  // Path length goes on counting from where the machine stands, so that plans before and after never disagree about
  // places.
  const double s = i.base_end_s();
  i.segments.clear();
  i.starts.clear();
  i.rest_after.clear();
  i.joiner.clear();
  i.moves_left = 0;
  i.origin = s;
  i.counted_s = s;
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
std::size_t Planner::moves_left() const noexcept {
  return impl_->moves_left;
}

std::vector<double> Planner::rest_joints() const {
  const auto* base = impl_->base();
  if (base == nullptr) return {};
  const Plan& plan = *base->plan;
  const PathView path(plan.segments, plan.segment_start);
  JointPoint point;
  if (path.evaluate(impl_->base_end_s(), 0, -1, point) != KinematicsStatus::Ok) return {};
  return {point.d[0].begin(), point.d[0].begin() + static_cast<std::ptrdiff_t>(impl_->model.joints.size())};
}

}  // namespace rmac
