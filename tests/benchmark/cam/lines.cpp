// Smooth curves as short lines: exact, and rounded as post-processors round.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "../motion/machines.hpp"
#include "../motion/shapes.hpp"
#include "curves/vector.hpp"
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
  double least = 1.02 * measure->time_s;
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

namespace {

using Shape = std::function<Vector(double)>;

/// A closed curve of four random harmonics, in ±40 mm.
Shape random_curve(std::mt19937_64& random) {
  std::array<std::array<double, 8>, 3> part{};
  for (auto& of_axis : part) {
    for (double& value : of_axis) value = std::uniform_real_distribution<>(-1, 1)(random);
  }
  return [part](double t) {
    Vector at{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t h = 0; h < 4; ++h) {
        const double angle = static_cast<double>(h + 1) * t, scale = (c == 2 ? 3.0 : 12.0) / static_cast<double>(h + 1);
        at[c] += scale * (part[c][2 * h] * std::cos(angle) + part[c][2 * h + 1] * std::sin(angle));
      }
    }
    return at;
  };
}

double least_radius_mm(const Shape& shape) {
  constexpr int kPlaces = 4000;
  double least = 1e300;
  for (int i = 0; i < kPlaces; ++i) {
    const double t = kRound * i / kPlaces, h = kRound / kPlaces;
    const Vector before = shape(t - h), here = shape(t), after = shape(t + h);
    const Vector first = scaled(0.5 / h, difference(after, before));
    const Vector second = scaled(1 / (h * h), along(difference(after, here), -1, difference(here, before)));
    least = std::min(least, std::pow(norm(first), 3) / norm(cross(first, second)));
  }
  return least;
}

/// Programs of curves in lines of these lengths, against the same curves as NURBS.
void against_nurbs(Figures& figures, const Extent& extent, const std::string& row, double least_radius,
                   double most_radius, const std::vector<double>& lines_mm) {
  std::mt19937_64 random(extent.seed);
  const int curves = extent.cases(8, 2);
  double worst = 0, worst_limits = 0, worst_off = 0;
  std::string where, failures;
  for (int curve = 0; curve < curves;) {
    const Shape shape = random_curve(random);
    const double radius = least_radius_mm(shape);
    if (radius < least_radius || radius > most_radius) continue;
    for (const auto& [acceleration, jerk] : {std::pair{1000.0, 10'000.0}, std::pair{2000.0, 50'000.0}}) {
      const PlannerModel model = bench_xyz(acceleration, jerk);
      const auto whole = machine(interpolated(shape, kRound, 5, 600), 0.01, 200, model);
      for (const double line_mm : lines_mm) {
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
    ++curve;
  }
  const std::string note = "worst of " + std::to_string(curves) + " curves, seed " + std::to_string(extent.seed);
  if (!failures.empty()) figures.missing(row, "<= 1.03", "of the NURBS", failures);
  figures.at_most(row, worst, 1.03, "of the NURBS", note + ": " + where);
  figures.at_most(row + "_limits", worst_limits, 1.001, "of limit", note);
  figures.at_most(row + "_off_the_lines", worst_off, 10, "µm", note);
}

}  // namespace

void curve_rows(Figures& figures, const Extent& extent) {
  // Chords of 0.5 mm miss a circle of 3 mm by the tolerance.
  against_nurbs(figures, extent, "curves_rounded_1um", 3, 1e300, {0.02, 0.05, 0.1, 0.2, 0.5});
  against_nurbs(figures, extent, "tight_curves_rounded_1um", 0.1, 1, {0.02, 0.05, 0.1});
}

namespace {

double face_mm(double x, double y) {
  return 3 * std::sin(x / 8) * std::cos(y / 6) + 2 * std::sin((x + y) / 11);
}

/// Passes over a free-form face, to and fro, in lines whose chords miss it by a micrometre.
std::vector<Vector> raster(std::size_t lines) {
  constexpr double kHalf_mm = 40, kStepOver_mm = 0.1, kChord_mm = 0.001, kStep_mm = 0.01;
  std::vector<Vector> corners{{-kHalf_mm, -kHalf_mm, face_mm(-kHalf_mm, -kHalf_mm)}};
  for (double y = -kHalf_mm, way = 1; corners.size() <= lines; y += kStepOver_mm, way = -way) {
    double x = -way * kHalf_mm;
    corners.push_back({x, y, face_mm(x, y)});
    while (way * x < kHalf_mm && corners.size() <= lines) {
      const double bend =
          std::abs(face_mm(x + kStep_mm, y) - 2 * face_mm(x, y) + face_mm(x - kStep_mm, y)) / (kStep_mm * kStep_mm);
      const double line = std::clamp(std::sqrt(8 * kChord_mm / std::max(bend, 1e-6)), 0.1, 0.8);
      x = way * std::min(way * x + line, kHalf_mm);
      corners.push_back({x, y, face_mm(x, y)});
    }
  }
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

}  // namespace

void raster_rows(Figures& figures, const Extent& extent) {
  const Program exact{raster(static_cast<std::size_t>(extent.cases(190'000, 9'500)))};
  const PlannerModel model = bench_xyz(2000, 50'000);
  const auto measure = machine(exact, model);
  if (!measure) {
    figures.missing("raster_exact", "", "s", measure.error());
    return;
  }
  figures.inform("raster_exact", measure->time_s, "s", std::to_string(exact.corners.size() - 1) + " lines");
  report(figures, "raster_rounded_1um", {rounded(exact.corners, kMicrometre)}, model, 1.03 * measure->time_s);
}

}  // namespace rmac::bench
