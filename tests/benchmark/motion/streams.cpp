#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "drive.hpp"
#include "limit_check.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

struct Outcome {
  bool ended = false;
  int rests = 0;  ///< times the machine stood still between the first move and the last
  double length_m = 0, travel_s = 0, planning_s = 0, worst = 0;
  std::vector<double> move_s;  ///< duration of each move
};

/// One stream of NURBS moves; a few are queued at a time, as a client would.
Outcome stream(const PlannerModel& model, double feed_mm_s, double wanted_m, std::int64_t most,
               const std::function<Nurbs()>& next) {
  Outcome outcome;
  Move move;
  move.feed_mm_s = feed_mm_s;
  move.tolerance_mm = 0.01;
  Nurbs nurbs = next();
  Drive drive(model, nurbs.points.front());
  LimitCheck check(model.joints);
  drive.on_travelled = [&](const Plan& plan, double from, double to) { check.travelled(plan, from, to); };
  bool moving = false;
  std::int64_t sent = 0, done = 0, since = 0;
  drive.on_setpoint = [&](const Setpoint& setpoint) {
    check.setpoint(setpoint);
    if (moving && !setpoint.moving &&
        !(done + setpoint.moves_done == sent && (outcome.length_m >= wanted_m || sent >= most)))
      ++outcome.rests;
    if (moving || setpoint.moving) outcome.travel_s += model.period_s;
    moving = setpoint.moving;
    for (std::uint32_t i = 0; i < setpoint.moves_done; ++i) {
      outcome.move_s.push_back(static_cast<double>(drive.now() - since) * model.period_s);
      since = drive.now();
      ++done;
    }
  };
  drive.planner.command(PathCommand::Run);
  std::int64_t last_done = 0, stuck = 0;
  const auto more = [&] { return outcome.length_m < wanted_m && sent < most; };
  while (done < sent || more()) {
    while (more() && drive.planner.moves_left() < 8) {
      move.id = ++sent;
      move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs};
      auto segments = drive.builder.build(move);
      if (!segments) return outcome;
      for (const auto& segment : *segments) outcome.length_m += 1e-3 * segment->length();
      drive.planner.add(std::move(*segments));
      nurbs = next();
    }
    drive.cycle();
    stuck = done == last_done ? stuck + 1 : 0;
    last_done = done;
    if (stuck > 600'000) return outcome;
  }
  drive.finish();
  outcome.ended = true;
  outcome.planning_s = drive.planning_s();
  outcome.worst = check.worst();
  return outcome;
}

void report(Figures& figures, const std::string& name, const Outcome& outcome, const std::string& note) {
  if (!outcome.ended) {
    figures.missing(name, "all moves done", "", "a move was refused or never ended");
    return;
  }
  figures.at_most(name + "_rests", outcome.rests, 0, "rests", note);
  figures.at_most(name + "_limits", outcome.worst, 1.001, "of limit", note);
  figures.inform(name + "_planning", outcome.travel_s / outcome.planning_s, "x real time", note);
}

}  // namespace

void stream_rows(Figures& figures, const Extent& extent) {
  const int laps = extent.cases(1000, 20);
  const Nurbs lap = interpolated(rose, 2 * std::numbers::pi, 5, 600);
  const Outcome round = stream(bench_xyz(2000, 50000), 100, 1e9, laps, [&] { return lap; });
  report(figures, "laps", round, std::to_string(laps) + " laps of the rose");
  if (round.ended && round.move_s.size() > 3) {
    // The first lap begins at rest and the last ends there.
    const std::vector<double> inner(round.move_s.begin() + 1, round.move_s.end() - 1);
    figures.at_most("laps_slowest", quantile(inner, 1) / quantile(inner, 0.5), 1.01, "of median lap",
                    "every lap reaches the feed again");
  }

  RandomSplines random(23);
  Nurbs before;
  const auto next = [&] {
    before = random.in_stream(before.points.empty() ? nullptr : &before);
    return before;
  };
  const Outcome splines = stream(bench_xyz(1000, 50000), 200, extent.cases(10'000, 20), 1'000'000'000, next);
  char note[80];
  std::snprintf(note, sizeof note, "%.2f km of random splines", 1e-3 * splines.length_m);
  report(figures, "splines_stream", splines, note);
}

}  // namespace rmac::bench
