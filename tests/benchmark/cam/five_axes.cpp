// Lines on which the tool axis turns, on the five-axis machines of the device tree: as CAM systems send the side of a
// blade, and through and past the pole.
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "../machines/device_tree.hpp"
#include "pose_program.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

constexpr double kRad = std::numbers::pi / 180;
constexpr double kMicrometre = 1e-3, kAxisDigit = 1e-6;
constexpr double kLinesASecond = 20'000, kTimesFaster = 5;
constexpr double kLength_mm = 59, kTurn_deg = 20;
constexpr std::array kMachines{"mill/5-axis/SuginoXYZAC", "mill/5-axis/TarusXYZCA"};
constexpr std::array kLines{60, 200, 600};

Vector leaning(double lean_rad, double around_rad) {
  return {std::sin(lean_rad) * std::cos(around_rad), std::sin(lean_rad) * std::sin(around_rad), std::cos(lean_rad)};
}

/// A gently waving way of the tip, 59 mm long.
struct Waves {
  double direction = 0, across_mm = 0, up_mm = 0, phase = 0;
  explicit Waves(std::mt19937_64& random) {
    const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    direction = between(0, 2 * std::numbers::pi);
    across_mm = between(1, 4);
    up_mm = between(1, 4);
    phase = between(0, 2 * std::numbers::pi);
  }
  [[nodiscard]] Vector at(double t) const {
    const double ahead = kLength_mm * (t - 0.5), aside = across_mm * std::sin(4 * t + phase);
    return {ahead * std::cos(direction) - aside * std::sin(direction),
            ahead * std::sin(direction) + aside * std::cos(direction), up_mm * std::cos(3 * t + 2 * phase)};
  }
};

/// The axis turns by 20 degrees, well away from the pole, and its lean waves meanwhile.
PoseShape flow_line(std::mt19937_64& random) {
  const Waves waves(random);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const double lean = between(15, 30) * kRad, around = between(-1, 1), wave = between(0.5, 2) * kRad;
  const double towards = between(-0.5, 0.5);
  return [=](double t) {
    const double turn = kTurn_deg * kRad * t;
    return ToolPose{waves.at(t), leaning(lean + std::cos(towards) * turn + wave * std::sin(5 * t),
                                         around + std::sin(towards) * turn / std::sin(lean))};
  };
}

/// The axis turns by 20 degrees on a great circle that passes the pole at `off_deg`, half way.
PoseShape past_pole(std::mt19937_64& random, double off_deg) {
  const Waves waves(random);
  const double around = std::uniform_real_distribution<>(0, 2 * std::numbers::pi)(random);
  const double off = off_deg * kRad;
  return [=](double t) {
    const double turn = kTurn_deg * kRad * (t - 0.5);
    const double ahead = std::sin(turn), aside = std::sin(off) * std::cos(turn);
    return ToolPose{waves.at(t),
                    {ahead * std::cos(around) - aside * std::sin(around),
                     ahead * std::sin(around) + aside * std::cos(around), std::cos(off) * std::cos(turn)}};
  };
}

struct Aim {
  std::string row;
  double times_nurbs = 0;
  double lines_a_second = 0;  ///< planned; 0 where most of the work is the pole, not the lines
};

/// A curve as lines, exact and rounded, against the same curve as one NURBS in pose space.
void against_nurbs(Figures& figures, const Extent& extent, const Aim& aim,
                   const std::function<PoseShape(std::mt19937_64&)>& next_shape) {
  for (const char* const folder : kMachines) {
    const auto model = model_of(folder);
    const std::string machine_name = std::string(folder).substr(std::string(folder).rfind('/') + 1);
    const std::string row = aim.row + "_" + machine_name;
    if (!model) {
      figures.missing(row, "", "of the NURBS", model.error());
      continue;
    }
    std::mt19937_64 random(extent.seed);
    const int curves = extent.cases(4, 1);
    double worst = 0, limits = 0, off_um = 0, axis_deg = 0, least_rate = 1e300, least_times = 1e300, longest_ms = 0;
    double nurbs_s = 0, lines_s = 0;
    int rests = 0;
    std::string where, failures;
    for (int curve = 0; curve < curves; ++curve) {
      const PoseShape shape = next_shape(random);
      const auto whole = machine(interpolated(shape), {corners_of(shape, 1)}, *model);
      if (!whole) {
        failures += "curve " + std::to_string(curve) + " as NURBS: " + whole.error() + "; ";
        continue;
      }
      for (const int lines : kLines) {
        for (const bool round : {false, true}) {
          const std::string name =
              "curve " + std::to_string(curve) + " as " + std::to_string(lines) + (round ? " rounded lines" : " lines");
          PoseProgram program{corners_of(shape, lines)};
          if (round) program.corners = rounded(program.corners, kMicrometre, kAxisDigit);
          const auto done = machine(program, *model);
          if (!done) {
            failures += name + ": " + done.error() + "; ";
            continue;
          }
          if (done->time_s / whole->time_s > worst) {
            worst = done->time_s / whole->time_s;
            where = name;
            lines_s = done->time_s;
            nurbs_s = whole->time_s;
          }
          limits = std::max(limits, done->limits);
          off_um = std::max(off_um, 1000 * done->deviation_mm);
          axis_deg = std::max(axis_deg, done->axis_deg);
          rests = std::max(rests, done->rests);
          if (lines == kLines.back()) least_rate = std::min(least_rate, lines / done->planning_s);
          least_times = std::min(least_times, done->time_s / done->planning_s);
          longest_ms = std::max(longest_ms, 1000 * done->longest_step_s);
        }
      }
    }
    const std::string note = "worst of " + std::to_string(curves) + " curves, seed " + std::to_string(extent.seed);
    if (!failures.empty()) figures.missing(row, "", "of the NURBS", failures);
    figures.at_most(row, worst, aim.times_nurbs, "of the NURBS", note + ": " + where);
    figures.inform(row + "_time", lines_s, "s", "the same; as NURBS " + std::to_string(nurbs_s) + " s");
    figures.at_most(row + "_limits", limits, 1.001, "of limit", note);
    figures.at_most(row + "_off_the_lines", off_um, 10, "µm", note);
    figures.at_most(row + "_axis_off", axis_deg, 0.1, "deg", note);
    figures.at_most(row + "_rests", rests, 0, "rests", note);
    figures.at_least(row + "_planned", least_times, kTimesFaster, "times the motion", note);
    const std::string rate_note = "as " + std::to_string(kLines.back()) + " lines; CPU time; " + note;
    if (aim.lines_a_second > 0) {
      figures.at_least(row + "_planned_lines", least_rate, aim.lines_a_second, "lines/s", rate_note);
    } else {
      figures.inform(row + "_planned_lines", least_rate, "lines/s", rate_note);
    }
    figures.inform(row + "_longest_step", longest_ms, "ms", "CPU time; " + note);
  }
}

}  // namespace

void flow_line_rows(Figures& figures, const Extent& extent) {
  against_nurbs(figures, extent, {"flow_lines", 1.05, kLinesASecond}, flow_line);
}

void pole_rows(Figures& figures, const Extent& extent) {
  for (const auto& [name, off_deg] :
       {std::pair{"through_the_pole", 0.0}, {"past_the_pole_by_0.05_deg", 0.05}, {"past_the_pole_by_0.5_deg", 0.5}}) {
    against_nurbs(figures, extent, {name, 1.2},
                  [off = off_deg](std::mt19937_64& random) { return past_pole(random, off); });
  }
}

}  // namespace rmac::bench
