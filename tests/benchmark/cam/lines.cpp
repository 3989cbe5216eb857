// Smooth curves as short lines: exact, and rounded as post-processors round.
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "../motion/machines.hpp"
#include "../motion/shapes.hpp"
#include "program.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

constexpr double kRound = 2 * std::numbers::pi;
constexpr double kMicrometre = 1e-3;
constexpr double kLinesASecond = 50'000;
constexpr double kTimesFaster = 80;

Vector trefoil(double t) {
  return {9 * (std::sin(t) + 2 * std::sin(2 * t)), 9 * (std::cos(t) - 2 * std::cos(2 * t)), -9 * std::sin(3 * t)};
}

std::string in_mm(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

/// Time, limits, path and rate of a program, by the time that it may take.
void report(Figures& figures, const std::string& name, const Program& program, const PlannerModel& model,
            double most_s) {
  const auto done = machine(program, model);
  if (!done) {
    figures.missing(name, "<= " + std::to_string(most_s), "s", done.error());
    return;
  }
  figures.at_most(name, done->time_s, most_s, "s");
  figures.at_most(name + "_limits", done->limits, 1.001, "of limit");
  figures.at_most(name + "_off_the_lines", 1000 * done->deviation_mm, 1000 * program.tolerance_mm, "µm");
  figures.at_most(name + "_rests", done->rests, 0, "rests");
  const double rate = static_cast<double>(program.corners.size() - 1) / done->planning_s;
  const double times = done->time_s / done->planning_s;
  if (times < kTimesFaster) {
    figures.at_least(name + "_planned", rate, kLinesASecond, "lines/s", "CPU time");
  } else {
    figures.inform(name + "_planned", rate, "lines/s", "CPU time; 80 times faster than the motion suffices");
  }
  figures.at_most(name + "_longest_step", 1000 * done->longest_step_s, 20, "ms", "CPU time");
}

}  // namespace

void trefoil_rows(Figures& figures, const Extent&) {
  const PlannerModel soft = bench_xyz();
  const Program exact{polyline(trefoil, kRound, 0.1)};
  const auto measure = machine(exact, soft);
  if (!measure) {
    figures.missing("trefoil_0.1mm_exact", "", "s", measure.error());
    return;
  }
  figures.inform("trefoil_0.1mm_exact", measure->time_s, "s", "the measure of the rows below");
  for (const double line_mm : {0.1, 0.05, 0.02, 0.2, 0.5}) {
    report(figures, "trefoil_" + in_mm(line_mm) + "mm_rounded_1um",
           {rounded(polyline(trefoil, kRound, line_mm), kMicrometre)}, soft, 1.02 * measure->time_s);
  }
  report(figures, "trefoil_0.1mm_rounded_10um", {rounded(polyline(trefoil, kRound, 0.1), 10 * kMicrometre), 0.02}, soft,
         1.05 * measure->time_s);
  double least = 1e300;
  for (const double tolerance_mm : {0.003, 0.01, 0.05}) {
    const auto done = machine({rounded(exact.corners, kMicrometre), tolerance_mm}, soft);
    const std::string name = "trefoil_0.1mm_rounded_1um_within_" + in_mm(1000 * tolerance_mm) + "um";
    if (!done) {
      figures.missing(name, "", "s", done.error());
      continue;
    }
    figures.at_most(name, done->time_s, least, "s", "more tolerance is never slower");
    figures.inform(name + "_off_the_lines", 1000 * done->deviation_mm, "µm");
    least = std::min(least, done->time_s);
  }
}

/// Closed curves of a few random harmonics, in ±40 mm.
void curve_rows(Figures& figures, const Extent& extent) {
  std::mt19937_64 random(extent.seed);
  const int curves = extent.cases(8, 2);
  double worst = 0, worst_limits = 0, worst_off = 0;
  std::string where, failures;
  for (int curve = 0; curve < curves; ++curve) {
    std::array<std::array<double, 8>, 3> part{};
    for (auto& of_axis : part) {
      for (double& value : of_axis) value = std::uniform_real_distribution<>(-1, 1)(random);
    }
    const auto shape = [&part](double t) {
      Vector at{};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t h = 0; h < 4; ++h) {
          const double angle = static_cast<double>(h + 1) * t,
                       scale = (c == 2 ? 3.0 : 12.0) / static_cast<double>(h + 1);
          at[c] += scale * (part[c][2 * h] * std::cos(angle) + part[c][2 * h + 1] * std::sin(angle));
        }
      }
      return at;
    };
    for (const auto& [acceleration, jerk] : {std::pair{1000.0, 10'000.0}, std::pair{2000.0, 50'000.0}}) {
      const PlannerModel model = bench_xyz(acceleration, jerk);
      const auto whole = machine(interpolated(shape, kRound, 5, 600), 0.01, 200, model);
      for (const double line_mm : {0.02, 0.1, 0.5}) {
        const auto done = machine({rounded(polyline(shape, kRound, line_mm), kMicrometre)}, model);
        const std::string name = "curve " + std::to_string(curve) + ", " + in_mm(line_mm) + " mm, jerk " + in_mm(jerk);
        if (!whole || !done) {
          failures += name + ": " + (whole ? done.error() : whole.error()) + "; ";
          continue;
        }
        const double ratio = done->time_s / whole->time_s;
        if (ratio > worst) {
          worst = ratio;
          where = name;
        }
        worst_limits = std::max(worst_limits, done->limits);
        worst_off = std::max(worst_off, 1000 * done->deviation_mm);
      }
    }
  }
  const std::string note = "worst of " + std::to_string(curves) + " curves, seed " + std::to_string(extent.seed);
  if (!failures.empty()) figures.missing("curves", "<= 1.03", "of the NURBS", failures);
  figures.at_most("curves_rounded_1um", worst, 1.03, "of the NURBS", note + ": " + where);
  figures.at_most("curves_rounded_1um_limits", worst_limits, 1.001, "of limit", note);
  figures.at_most("curves_rounded_1um_off_the_lines", worst_off, 10, "µm", note);
}

}  // namespace rmac::bench
