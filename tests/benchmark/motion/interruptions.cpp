#include <algorithm>
#include <cmath>
#include <string>

#include "drive.hpp"
#include "exact_nurbs.hpp"
#include "limit_check.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"
#include "shortest_stop.hpp"

namespace rmac::bench {
namespace {

constexpr int kInstantsOfSpline = 10;

struct Outcome {
  int instants = 0, unfinished = 0, holds = 0, kept = 0, overrides_kept = 0;
  double worst = 0, off_nm = 0;
  std::vector<double> reaction_cycles, visible_cycles, stop_ratio, planning_ms;
  std::vector<double> lowered_cycles, raised_cycles, override_ms, lowered_visible, raised_visible;
};

/// Path length of a plan at a time, for a comparison with what came instead.
PathState state_of(const Plan& plan, double t) {
  if (t >= plan.end_time_s) {
    const LawPiece& last = plan.law.back();
    return {last.at(last.duration).s, 0, 0};
  }
  auto piece =
      std::upper_bound(plan.law.begin(), plan.law.end(), t, [](double at, const LawPiece& p) { return at < p.t0; });
  if (piece != plan.law.begin()) --piece;
  return piece->at(t - piece->t0);
}

/// One spline, travelled with interruptions at random instants.
class Case {
 public:
  Case(RandomSplines& random, Outcome& outcome)
      : random_(random),
        outcome_(outcome),
        nurbs_(random.three_axis()),
        exact_(nurbs_),
        model_(bench_xyz()),
        drive_(model_, nurbs_.points.front()),
        check_(model_.joints) {
    u_ = exact_.begin();
    drive_.on_travelled = [this](const Plan& plan, double from, double to) { check_.travelled(plan, from, to); };
    drive_.on_setpoint = [this](const Setpoint& setpoint) { look(setpoint); };
    Move move;
    move.id = 1;
    move.feed_mm_s = random_.uniform(20, 200);
    move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs_};
    queued_ = drive_.queue(move).has_value();
  }

  void travel() {
    if (!queued_) {
      ++outcome_.unfinished;
      return;
    }
    drive_.planner.command(PathCommand::Run);
    for (int i = 0; i < kInstantsOfSpline; ++i) {
      const auto wait = static_cast<int>(random_.uniform(1, 400));
      for (int k = 0; k < wait; ++k) drive_.cycle();
      if (drive_.planner.moves_left() == 0) break;
      ++outcome_.instants;
      if (random_.uniform(0, 1) < 0.4) {
        override_step();
      } else {
        hold();
      }
    }
    drive_.planner.set_override(150);
    drive_.planner.command(PathCommand::Run);
    if (!drive_.run(200'000)) ++outcome_.unfinished;
    drive_.finish();
    outcome_.worst = std::max(outcome_.worst, check_.worst());
  }

 private:
  void look(const Setpoint& setpoint) {
    check_.setpoint(setpoint);
    if (!setpoint.moving) return;
    const double* const tip = setpoint.position.data();
    u_ = std::min(u_ + setpoint.feed_mm_s * static_cast<Real>(model_.period_s) / exact_.speed(u_), exact_.end());
    if (drive_.now() % 8 != 0) return;
    u_ = exact_.nearest(tip, u_);
    outcome_.off_nm = std::max(outcome_.off_nm, 1e6 * static_cast<double>(exact_.distance(tip, u_)));
  }

  void override_step() {
    const double percent = random_.uniform(0, 1) < 0.1 ? 0 : random_.uniform(1, 200);
    const auto before = drive_.plan_followed();
    const bool measured = percent > 0 && before != nullptr && drive_.setpoint().feed_mm_s > 1;
    const bool lowered = percent < override_percent_;
    drive_.planner.set_override(percent);
    if (percent > 0) override_percent_ = percent;
    if (measured) {
      // Before the next cycle answers it, nothing else is asked.
      const double answer_ms = 1e3 * drive_.plan();
      const std::int64_t asked = drive_.now();
      while (drive_.plan_followed() == before && drive_.setpoint().feed_mm_s > 0) drive_.cycle();
      if (drive_.plan_followed() != before) {
        (lowered ? outcome_.lowered_cycles : outcome_.raised_cycles)
            .push_back(static_cast<double>(drive_.now() - asked));
        outcome_.override_ms.push_back(answer_ms);
        while (keeps(*before) && drive_.setpoint().feed_mm_s > 0) drive_.cycle();
        (lowered ? outcome_.lowered_visible : outcome_.raised_visible)
            .push_back(static_cast<double>(drive_.now() - asked));
      } else {
        ++outcome_.overrides_kept;
      }
    }
    if (percent > 0) return;
    const auto wait = static_cast<int>(random_.uniform(1, 600));
    for (int k = 0; k < wait; ++k) drive_.cycle();
    override_percent_ = random_.uniform(1, 200);
    drive_.planner.set_override(override_percent_);
  }

  /// The setpoint is where this plan has it, to 1 pm.
  bool keeps(const Plan& plan) const {
    const double t = static_cast<double>(drive_.now() - plan.start_cycle) * model_.period_s;
    return std::abs(drive_.setpoint().s_mm - state_of(plan, t).s) <= 1e-9;
  }

  /// Cycles after the command that still follow the plan in force when it came, and the way to rest from there.
  void hold() {
    const auto before = drive_.plan_followed();
    const std::int64_t asked = drive_.now();
    const bool measured = before != nullptr && drive_.setpoint().feed_mm_s > 1;
    drive_.planner.command(PathCommand::Stop);
    const double answer_ms = 1e3 * drive_.plan();
    if (measured) outcome_.planning_ms.push_back(answer_ms);
    std::int64_t answered = -1;  // cycles after the command from which the plan followed ends at rest for it
    const bool impatient = random_.uniform(0, 1) < 0.2;
    std::int64_t followed = -1;    // cycles after the command that show the plan in force before it
    std::int64_t taken_over = -1;  // cycles after the command in which another plan takes over
    const std::size_t most = impatient ? static_cast<std::size_t>(random_.uniform(1, 150)) : 5000;
    bool rested = false;
    for (std::size_t k = 0; k < most && !rested; ++k) {
      drive_.cycle();
      if (answered < 0 && drive_.stops()) answered = drive_.now() - asked;
      if (measured && followed < 0) {
        if (taken_over < 0 && drive_.plan_followed() != before) taken_over = drive_.now() - asked;
        if (!keeps(*before)) followed = drive_.now() - 1 - asked;
      }
      rested = drive_.resting();
    }
    if (measured && !impatient && rested) {
      ++outcome_.holds;
      if (taken_over < 0) ++outcome_.kept;
      outcome_.reaction_cycles.push_back(answered < 0 ? 5000 : static_cast<double>(answered));
      if (followed >= 0) outcome_.visible_cycles.push_back(static_cast<double>(followed));
      // Both ways are measured from where a new plan may begin: what lies before it was under way already.
      const double t = static_cast<double>(asked + 2 - before->start_cycle) * model_.period_s;
      const PathState left = state_of(*before, t);
      const double shortest = shortest_stop_mm(*before->segments.front(), model_.joints, left);
      if (std::isfinite(shortest) && shortest > 0.01 && before->segments.size() == 1)
        outcome_.stop_ratio.push_back((drive_.setpoint().s_mm - left.s) / shortest);
    }
    drive_.planner.command(PathCommand::Run);
  }

  RandomSplines& random_;
  Outcome& outcome_;
  Nurbs nurbs_;
  ExactNurbs exact_;
  PlannerModel model_;
  Drive drive_;
  LimitCheck check_;
  Real u_ = 0;
  double override_percent_ = 100;
  bool queued_ = false;
};

}  // namespace

void interruption_rows(Figures& figures, const Extent& extent) {
  const int wanted = extent.cases(10'000, 500);
  RandomSplines random(static_cast<unsigned>(16 + extent.seed));
  Outcome outcome;
  while (outcome.instants < wanted) Case(random, outcome).travel();
  const std::string note = std::to_string(outcome.instants) + " instants";
  const std::string holds = std::to_string(outcome.holds) + " holds";
  figures.at_most("interruptions_limits", outcome.worst, 1.001, "of limit", note);
  figures.at_most("interruptions_off_curve", outcome.off_nm, 1, "nm", note);
  figures.at_most("interruptions_unfinished", outcome.unfinished, 0, "programs", note);
  // "Reaction": the cycles until the plan that is followed ends at rest for the hold, which may be the one before, up
  // to where it is left or comes to rest.
  figures.at_most("hold_reaction_p50", quantile(outcome.reaction_cycles, 0.5), 2, "cycles", holds);
  figures.inform("hold_reaction_p95", quantile(outcome.reaction_cycles, 0.95), "cycles", holds);
  figures.at_most("hold_reaction_max", quantile(outcome.reaction_cycles, 1), 2, "cycles", holds);
  const auto late = [](const std::vector<double>& all) {
    return static_cast<double>(std::ranges::count_if(all, [](double cycles) { return cycles > 2; }));
  };
  figures.inform("hold_late", late(outcome.reaction_cycles), "holds", holds + ", those with more than 2 cycles");
  figures.inform("hold_visible_p99", quantile(outcome.visible_cycles, 0.99), "cycles",
                 "until the setpoint differs by 1 pm");
  figures.inform("hold_kept_plan", outcome.kept, "holds", "no plan took over: the one in force came to rest");
  figures.at_most("hold_distance_p50", quantile(outcome.stop_ratio, 0.5), 1.2, "of shortest", holds);
  figures.inform("hold_distance_p99", quantile(outcome.stop_ratio, 0.99), "of shortest", holds);
  figures.inform("hold_planning_p50", quantile(outcome.planning_ms, 0.5), "ms", "CPU time");
  figures.inform("hold_planning_p99", quantile(outcome.planning_ms, 0.99), "ms", "CPU time");
  figures.at_most("hold_planning_max", quantile(outcome.planning_ms, 1), 1, "ms", "CPU time of the step that answers");
  const auto override_rows = [&](const std::string& way, const auto& taken_over, const auto& visible) {
    const std::string name = "override_" + way, all = std::to_string(taken_over.size()) + " overrides " + way;
    figures.inform(name + "_late", late(taken_over), "overrides", all);
    figures.inform(name + "_p99", quantile(taken_over, 0.99), "cycles", all);
    figures.at_most(name + "_max", quantile(taken_over, 1), 2, "cycles", all);
    figures.inform(name + "_visible_p50", quantile(visible, 0.5), "cycles", "until the setpoint differs by 1 pm");
    figures.inform(name + "_visible_p99", quantile(visible, 0.99), "cycles", all);
    figures.inform(name + "_visible_max", quantile(visible, 1), "cycles", all);
  };
  override_rows("lowered", outcome.lowered_cycles, outcome.lowered_visible);
  override_rows("raised", outcome.raised_cycles, outcome.raised_visible);
  figures.inform("override_kept_plan", outcome.overrides_kept, "overrides",
                 "in no row above: the plan in force came to rest");
  figures.inform("override_planning_p50", quantile(outcome.override_ms, 0.5), "ms", "CPU time");
  figures.inform("override_planning_p99", quantile(outcome.override_ms, 0.99), "ms", "CPU time");
  figures.at_most("override_planning_max", quantile(outcome.override_ms, 1), 1, "ms", "CPU time");
}

}  // namespace rmac::bench
