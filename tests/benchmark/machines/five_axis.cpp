#include <cmath>
#include <numbers>
#include <string>

#include "drive.hpp"
#include "limit_check.hpp"
#include "rmac/modules/chain_kinematics.hpp"
#include "rows.hpp"
#include "shapes.hpp"

namespace rmac::bench {
namespace {

constexpr double kRad = std::numbers::pi / 180;
constexpr double kPivot_mm = 100;

PlannerModel three_axes() {
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(modules::cartesian(3));
  for (const char* name : {"X", "Y", "Z"}) {
    model.joints.push_back({name, JointType::Linear, JointLimitType::Limited, -400, 400, 200, 2000, 50000});
  }
  return model;
}

/// Slides with a head on them that turns by C and leans by A about a line above the tool interface.
PlannerModel head() {
  PlannerModel model = three_axes();
  const modules::ScrewAxis x{JointType::Linear, {1, 0, 0}, {}}, y{JointType::Linear, {0, 1, 0}, {}},
      z{JointType::Linear, {0, 0, 1}, {}}, c{JointType::Rotary, {0, 0, 1}, {}},
      a{JointType::Rotary, {1, 0, 0}, {0, 0, kPivot_mm}};
  model.kinematics = std::make_shared<modules::ChainKinematics>(std::vector{x, y, z, c, a},
                                                                std::vector<std::size_t>{0, 1, 2, 3, 4}, Frame{});
  model.joints.push_back({"C", JointType::Rotary, JointLimitType::Infinite, 0, 0, 90, 500, 5000});
  model.joints.push_back({"A", JointType::Rotary, JointLimitType::Limited, -110, 110, 90, 500, 5000});
  return model;
}

struct Run {
  double time_s = 0;
  double worst_limit = 0;
  double least_feed_mm_s = 1e30;  ///< between the first and the last 0.2 s
  std::vector<std::vector<double>> joints;
};

tl::expected<Run, std::string> machine(const PlannerModel& model, const Move& move, const std::vector<double>& start) {
  Drive drive(model, start);
  LimitCheck check(model.joints, model.max_feed_mm_s);
  Run run;
  std::vector<double> feeds;
  drive.on_travelled = [&](const Plan& plan, double from, double to) { check.travelled(plan, from, to); };
  drive.on_setpoint = [&](const Setpoint& setpoint) {
    check.setpoint(setpoint);
    if (!setpoint.moving) return;
    feeds.push_back(setpoint.feed_mm_s);
    run.joints.emplace_back(setpoint.position.begin(),
                            setpoint.position.begin() + static_cast<std::ptrdiff_t>(model.joints.size()));
  };
  if (auto queued = drive.queue(move); !queued) return tl::unexpected(queued.error().message);
  drive.planner.command(PathCommand::Run);
  if (!drive.run(600'000)) return tl::unexpected(std::string("did not come to its end within 600 s"));
  drive.finish();
  run.time_s = static_cast<double>(feeds.size()) * model.period_s;
  run.worst_limit = check.worst();
  constexpr std::size_t kRamp = 200;
  for (std::size_t i = kRamp; i + kRamp < feeds.size(); ++i) {
    run.least_feed_mm_s = std::min(run.least_feed_mm_s, feeds[i]);
  }
  return run;
}

Move nurbs_move(NurbsSpace space, Nurbs curve) {
  Move move;
  move.id = 1;
  move.feed_mm_s = 50;
  move.geometry = NurbsGeometry{space, std::move(curve)};
  return move;
}

void rose_row(Figures& figures) {
  const double round = 2 * std::numbers::pi;
  constexpr int kPoints = 600;
  const Nurbs tip = interpolated(rose, round, 5, kPoints);
  Nurbs swinging = tip;
  const Nurbs axis = interpolated(
      [](double angle) {
        const double lean = 10 * kRad * std::sin(3 * angle);
        return Vector{std::sin(lean), 0, std::cos(lean)};
      },
      round, 5, kPoints);
  swinging.dimension = 6;
  for (std::size_t i = 0; i < swinging.points.size(); ++i) {
    swinging.points[i].insert(swinging.points[i].end(), axis.points[i].begin(), axis.points[i].end());
  }
  const Vector start = rose(0);
  const auto plain = machine(three_axes(), nurbs_move(NurbsSpace::Tip, tip), {start[0], start[1], start[2]});
  // C stands where the axis swings.
  const auto five = machine(head(), nurbs_move(NurbsSpace::Pose, swinging), {start[0], start[1], start[2], 90, 0});
  if (!plain || !five) {
    figures.missing("rose_swinging_axis", ">= 0.7", "of the speed", plain ? five.error() : plain.error());
    return;
  }
  figures.inform("rose_three_axes", plain->time_s, "s");
  figures.inform("rose_swinging_axis_time", five->time_s, "s");
  figures.at_least("rose_swinging_axis", plain->time_s / five->time_s, 0.7, "of the speed");
  figures.at_most("rose_swinging_axis_limits", five->worst_limit, 1.001, "of limit");
  figures.at_least("rose_swinging_axis_least_feed", five->least_feed_mm_s, 0.1, "mm/s", "no stop");
}

Vector leaning(double lean, double around) {
  return {std::sin(lean * kRad) * std::cos(around * kRad), std::sin(lean * kRad) * std::sin(around * kRad),
          std::cos(lean * kRad)};
}

/// Lines of 40 mm whose axis leans from 20 degrees on one side to 20 on the other and passes the pole by `off`.
void pole_row(Figures& figures, const std::string& name, double off, double around) {
  const PlannerModel model = head();
  const double beside = std::asin(std::sin(off * kRad) / std::sin(20 * kRad)) / kRad;
  const ToolPose from{{-20, 0, 0}, leaning(20, around + beside)}, to{{20, 0, 0}, leaning(20, around + 180 - beside)};
  std::vector<double> start(5), seed(5);
  if (model.kinematics->inverse(from, {}, seed, start) != KinematicsStatus::Ok) return;
  Move move;
  move.id = 1;
  move.feed_mm_s = 50;
  move.geometry = LineGeometry{from, to};
  const auto run = machine(model, move, start);
  if (!run) {
    figures.missing(name, "<= 1000", "nm", run.error());
    return;
  }
  double worst_mm = 0;
  for (const auto& joints : run->joints) {
    ToolPose pose;
    model.kinematics->forward(joints, {}, pose);
    worst_mm = std::max(worst_mm, std::hypot(pose.tip[1], pose.tip[2]));
  }
  figures.at_most(name + "_tip", worst_mm * 1e6, 1000, "nm");
  figures.at_most(name + "_limits", run->worst_limit, 1.001, "of limit");
  figures.inform(name + "_time", run->time_s, "s");
}

}  // namespace

void five_axis_rows(Figures& figures) {
  rose_row(figures);
  pole_row(figures, "through_the_pole", 0, 35);
  pole_row(figures, "past_the_pole_by_0.01_deg", 0.01, 35);
  pole_row(figures, "past_the_pole_by_0.5_deg", 0.5, 35);
}

}  // namespace rmac::bench
