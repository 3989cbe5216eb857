#include <algorithm>
#include <numbers>
#include <optional>
#include <string>

#include "drive.hpp"
#include "limit_check.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

constexpr double kFeed_mm_s = 100;
constexpr double kTolerance_mm = 0.01;
constexpr double kRound = 2 * std::numbers::pi;

struct Run {
  double time_s = 0;
  double worst = 0;  ///< of the joints' limits
};

/// Machines moves from rest to rest; an error's message when one is refused or the run does not end.
tl::expected<Run, std::string> machine(const std::vector<Move>& moves, const Vector& start) {
  const PlannerModel model = bench_xyz(2000, 50000);
  Drive drive(model, {start[0], start[1], start[2]});
  LimitCheck check(model.joints, model.max_feed_mm_s);
  drive.on_travelled = [&](const Plan& plan, double from, double to) { check.travelled(plan, from, to); };
  std::int64_t moving = 0;
  drive.on_setpoint = [&](const Setpoint& setpoint) {
    check.setpoint(setpoint);
    moving += setpoint.moving ? 1 : 0;
  };
  for (const Move& move : moves) {
    if (auto queued = drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  }
  drive.planner.command(PathCommand::Run);
  if (!drive.run(600'000)) return tl::unexpected(std::string("did not come to its end within 600 s"));
  drive.finish();
  return Run{static_cast<double>(moving) * model.period_s, check.worst()};
}

std::vector<Move> lines(double line_mm) {
  const auto corners = polyline(rose, kRound, line_mm);
  std::vector<Move> moves;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Move move;
    move.id = static_cast<std::int64_t>(i) + 1;
    move.feed_mm_s = kFeed_mm_s;
    move.tolerance_mm = kTolerance_mm;
    move.geometry = LineGeometry{{corners[i], kUp}, {corners[i + 1], kUp}};
    moves.push_back(std::move(move));
  }
  return moves;
}

}  // namespace

void rose_rows(Figures& figures, const Extent&) {
  std::optional<double> of_fifths;
  const auto report = [&](const std::string& name, const std::vector<Move>& moves, double target_s) {
    const auto run = machine(moves, rose(0));
    if (!run) {
      figures.missing(name, "<= " + std::to_string(target_s), "s", run.error());
      return;
    }
    figures.at_most(name, run->time_s, target_s, "s");
    figures.at_most(name + "_limits", run->worst, 1.001, "of limit");
    if (!of_fifths) of_fifths = run->time_s;
  };
  report("rose_lines_0.2mm", lines(0.2), 3.08);
  const double near = 1.02 * std::min(of_fifths.value_or(3.08), 3.08);
  report("rose_lines_0.05mm", lines(0.05), near);
  Move whole;
  whole.id = 1;
  whole.feed_mm_s = kFeed_mm_s;
  whole.tolerance_mm = kTolerance_mm;
  whole.geometry = NurbsGeometry{NurbsSpace::Tip, interpolated(rose, kRound, 5, 600)};
  report("rose_one_nurbs", {whole}, near);
  report("rose_lines_1mm", lines(1), 3.35);
}

}  // namespace rmac::bench
