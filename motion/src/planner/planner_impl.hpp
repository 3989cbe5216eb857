#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "planner/failed_attempt.hpp"
#include "planner/next_window.hpp"
#include "planner/planning_time.hpp"
#include "planner/prompt_law.hpp"
#include "planner/published_plans.hpp"
#include "planner/route.hpp"
#include "rmac/motion/planner.hpp"
#include "time_law/window.hpp"

namespace rmac {

/// How a plan is left for a window: as soon as can be, or so many cycles later; `Window::braking`.
struct Leaving {
  int later = 0;
  double braking = kBraking;
};

/// What the planner knows and does, a step at a time: which task is next (planner.cpp), the windows of motion
/// (planner_windows.cpp), and what takes motion back, holds and lowered overrides (planner_stops.cpp). What answers
/// whether a plan was published says so.
struct Planner::Impl {
  PlannerModel model;
  const Interruption* interruption = nullptr;

  Route route;

  PublishedPlans plans;
  PlanningTime planning_time;
  FailedAttempt attempt;
  std::size_t law_attempt = 0;      ///< at the law of a window, of several
  std::size_t leaving_attempt = 0;  ///< of the ways in which an override leaves its plan, the next one
  bool stop_came_late = false;      ///< of the stops tried since the last command: the next is left the time it takes
  PathCommand wanted = PathCommand::Stop;
  double factor = 1;     ///< the override
  double limit_s = 0;    ///< path length at which RunOne ends
  double origin_mm = 0;  ///< of the forward path's length: so far behind the first one's
  bool rest_follows = false;

  Impl(PlannerModel m, PlanChannel& channel) : model(std::move(m)), route(model), plans(channel, model.period_s) {}

  void command(PathCommand command);
  void set_override(double percent);
  /// What there is to do, if anything; the order is the order of urgency.
  enum class Task { None, Stop, StopSooner, Turn, Override, Supply, Start, Extend };
  [[nodiscard]] Task task(const ServoProgress& progress) const;
  bool step(const ServoProgress& progress);
  /// Takes note of where the machine is. False while that is not known: a refused plan is still to come back through
  /// `retired`.
  bool follow(const ServoProgress& progress);
  /// Where on its path the follower left it, everything ends that was published.
  void take_note_of(const ServoProgress& progress);
  /// Sets RunOne's limit. After a retrace, the move that is run is the one not yet done.
  void limit_run();

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

  [[nodiscard]] WindowEnd window_end(const PathState& from, double ramps, std::size_t most_nodes = kMostNodes);
  bool start_from_rest(const ServoProgress& progress);
  /// Adds the next window to the plan that is followed: behind its end where the path demands rest there, else from its
  /// commit point.
  bool extend(const ServoProgress& progress);
  /// Leaves the plan for the window behind it or (s_stop given) to stop there.
  bool divert(const ServoProgress& progress, std::optional<double> s_stop, const Leaving& leaving);
  bool publish(std::unique_ptr<Plan> plan, const WindowEnd& end, double window_begin, const Purpose& purpose = {});
  /// The law that was to begin a window was not found; there may be others to be tried, one a step.
  bool next_attempt(const ServoProgress& progress, std::size_t attempts);
  bool no_plan(const ServoProgress& progress, std::int64_t retry_after = FailedAttempt::kRetryAfter);

  /// Brakes as soon as can be, by a law that is found at once, before the path's next rest. `purpose.better_tries`: so
  /// often a better one is looked for afterwards, unless this one brakes as hard as can be from its begin on and is
  /// asked to stop.
  bool brake(const ServoProgress& progress, std::int64_t lead, double rest, Purpose purpose);
  /// A lowered override is answered by braking at once, from where a law for it goes on. Where that finds no law, as
  /// for a raised one, the plan is left for a window: at once, or later, which is tried one a step; one that leaves
  /// later takes over as soon, and is bettered until it does. Where nothing is found again and again, there is a law
  /// from rest.
  bool follow_override(const ServoProgress& progress);
  /// The next demanded rest on a plan that is followed, or its end, behind where it is in a cycle.
  [[nodiscard]] double rest_behind(const PublishedPlan& p, std::int64_t cycle) const;
  bool stop(const ServoProgress& progress);
  /// Cuts the followed plan off at path length `rest`, where it stands still anyway.
  bool end_at_rest(const ServoProgress& progress, double rest);
  [[nodiscard]] bool ends_sooner(const PromptLaw& found) const;
  /// Looks for a stop that ends sooner than the one that is under way: one window a step.
  bool stop_sooner(const ServoProgress& progress);
};

}  // namespace rmac
