#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "planner/laid_path.hpp"
#include "rmac/motion/plan.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {

/// What a plan is for, beside going on.
struct Purpose {
  bool stops = false;    ///< made to stop: the path goes on behind its end, but motion does not
  int better_tries = 0;  ///< it was found at once; so often a better one is looked for
};

/// A published plan with what the planner must remember of it. Times count from the plan's start, in s.
struct PublishedPlan {
  std::unique_ptr<const Plan> plan;
  std::vector<LawPiece> law;  ///< the plan's, by the path length of today, whose origin may have moved since
  Purpose purpose;
  bool hard_end = false;    ///< it ends where the path demands rest
  std::uint64_t turns = 0;  ///< of the route, when it was made
  double override_factor = 1;
  double commit_t = 0;  ///< up to here a following window keeps it

  [[nodiscard]] double end_s() const;
  /// The first cycle from this one on in which it may be followed: it may not have begun.
  [[nodiscard]] std::int64_t followed_from(std::int64_t cycle) const noexcept {
    return std::max(cycle, plan->start_cycle);
  }
  /// The state at t; at rest at the end from there on.
  [[nodiscard]] PathState state_at(double t) const;
  /// The time at which the first piece of law begins at or behind path length s; else the end.
  [[nodiscard]] double time_at(double s) const;
  /// From a time on it comes so near to this feed that it may be slower for its sake.
  [[nodiscard]] bool slowed_by(const FeedRule& feed, const PathView& path, double t) const;
  /// Law pieces between two times, with times counted from the first; the first piece may begin before.
  [[nodiscard]] std::vector<LawPiece> pieces_between(double t_begin, double t_end) const;
  /// Counts path length from a place `distance_mm` further along, as LaidPath::move_origin() does.
  void move_origin(double distance_mm);
};

/// Appends `tail`, whose times are moved by `t0`.
void append_law(std::vector<LawPiece>& law, const std::vector<LawPiece>& tail, double t0);

/// The plan that goes on as `before` from this cycle on, until a time of it, and then by `law`, whose times begin at 0.
/// It says which cycles it may be taken over in; its segments are to be added.
[[nodiscard]] std::unique_ptr<Plan> go_on_as(const PublishedPlan& before, std::int64_t cycle, double leaves_t,
                                             const std::vector<LawPiece>& law, double period_s);

/// Says when a plan ends, and which segments of the path it needs.
void lay_out(Plan& plan, const LaidPath& path, double period_s);

/// The time up to which a plan is kept when more path comes: before it brakes for its own end, and not all of its last
/// window, which begins at path length `window_begin`: less the last `planned_again` of it, in mm, at least half.
[[nodiscard]] double commit_time(const Plan& plan, double window_begin, double planned_again);

}  // namespace rmac
