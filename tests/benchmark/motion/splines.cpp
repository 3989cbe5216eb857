#include <cmath>
#include <numbers>
#include <string>

#include "drive.hpp"
#include "exact_nurbs.hpp"
#include "fastest_without_jerk.hpp"
#include "limit_check.hpp"
#include "machines.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

constexpr double kFeed_mm_s = 200;

/// Joints of the fork head for a pose, in extended precision and written apart from the bench's kinematics.
void fork_joints(const RealPoint& pose, Real* out) {
  Real axis[3], size = 0;
  for (std::size_t c = 0; c < 3; ++c) size += pose[c + 3] * pose[c + 3];
  for (std::size_t c = 0; c < 3; ++c) axis[c] = pose[c + 3] / std::sqrt(size);
  const Real degrees = 180 / std::numbers::pi_v<Real>;
  for (std::size_t c = 0; c < 3; ++c) out[c] = pose[c] + kPivot_mm * axis[c];
  out[2] -= kPivot_mm;
  out[4] = std::asin(axis[0]) * degrees;
  out[3] = std::atan2(-axis[1], axis[2]) * degrees;
  for (std::size_t c = 0; c < 3; ++c) out[c + 5] = pose[c];
}

struct Outcome {
  std::vector<double> ratios;
  double worst = 0;   ///< part of a joint limit
  double off_nm = 0;  ///< setpoints from the exact curve
  int unplanned = 0;
  double planning_s = 0, travel_s = 0;
  std::size_t worst_case = 0;
};

void travel(const Nurbs& nurbs, bool five_axis, std::size_t number, Outcome& outcome) {
  const PlannerModel model = five_axis ? bench_xyzab(1000, 50000) : bench_xyz(1000, 50000);
  const ExactNurbs exact(nurbs);
  const PathFunction path = [&](Real u, Real* out) {
    const RealPoint pose = exact.at(u, 0)[0];
    if (five_axis) {
      fork_joints(pose, out);
    } else {
      for (std::size_t c = 0; c < 3; ++c) out[c] = out[c + 3] = pose[c];
    }
  };
  Real joints[8];
  path(exact.begin(), joints);
  std::vector<double> start;
  for (std::size_t j = 0; j < model.joints.size(); ++j) start.push_back(static_cast<double>(joints[j]));

  Drive drive(model, start);
  LimitCheck check(model.joints, model.max_feed_mm_s);
  std::int64_t moving = 0;
  Real u = exact.begin();
  drive.on_travelled = [&](const Plan& plan, double from, double to) { check.travelled(plan, from, to); };
  drive.on_setpoint = [&](const Setpoint& setpoint) {
    check.setpoint(setpoint);
    if (!setpoint.moving) return;
    ++moving;
    const double* const tip = setpoint.pose.tip.data();
    // From one setpoint to the next along the tangent, so that Newton's method stays on the same branch.
    u = std::min(u + setpoint.feed_mm_s * static_cast<Real>(model.period_s) / exact.speed(u), exact.end());
    if (moving % 8 != 0) return;  // the exact evaluator is slow
    u = exact.nearest(tip, u);
    outcome.off_nm = std::max(outcome.off_nm, 1e6 * static_cast<double>(exact.distance(tip, u)));
  };
  Move move;
  move.id = 1;
  move.feed_mm_s = kFeed_mm_s;
  move.geometry = NurbsGeometry{five_axis ? NurbsSpace::Pose : NurbsSpace::Tip, nurbs};
  const auto queued = drive.queue(move);
  drive.planner.command(PathCommand::Run);
  if (!queued || !drive.run(600'000)) {
    ++outcome.unplanned;
    std::fprintf(stderr, "spline %zu: %s\n", number, queued ? "did not end" : queued.error().message.c_str());
    return;
  }
  drive.finish();
  const double time_s = static_cast<double>(moving) * model.period_s;
  const double bound_s = fastest_without_jerk_s(path, exact.begin(), exact.end(), model.joints, kFeed_mm_s);
  outcome.ratios.push_back(time_s / bound_s);
  outcome.planning_s += drive.planning_s();
  outcome.travel_s += time_s;
  if (check.worst() > outcome.worst) outcome.worst = check.worst(), outcome.worst_case = number;
}

}  // namespace

void spline_rows(Figures& figures, const Extent& extent) {
  const int count = extent.cases(1000, 50);
  for (const bool five_axis : {false, true}) {
    const std::string name = five_axis ? "splines_five_axis" : "splines_three_axis";
    const std::string note = std::to_string(count) + " splines";
    RandomSplines random(five_axis ? 5 : 3);
    Outcome outcome;
    for (int i = 0; i < count; ++i)
      travel(five_axis ? random.five_axis() : random.three_axis(), five_axis, static_cast<std::size_t>(i), outcome);
    figures.at_most(name + "_time_p50", quantile(outcome.ratios, 0.5), 1.05, "of bound", note);
    figures.at_most(name + "_time_p99", quantile(outcome.ratios, 0.99), 1.10, "of bound", note);
    figures.at_most(name + "_limits", outcome.worst, 1.001, "of limit",
                    note + ", worst is number " + std::to_string(outcome.worst_case));
    figures.at_most(name + "_unplanned", outcome.unplanned, 0, "splines", note);
    figures.at_most(name + "_off_curve", outcome.off_nm, 1, "nm", note);
    figures.inform(name + "_planning", outcome.travel_s / outcome.planning_s, "x real time", note);
  }
}

}  // namespace rmac::bench
