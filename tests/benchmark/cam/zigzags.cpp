// Programs that bend to and fro: hard for a planner, since every place limits what the next may do.
#include <algorithm>
#include <string>

#include "../motion/machines.hpp"
#include "program.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

constexpr double kTimesFaster = 5;
constexpr double kLongestStep_ms = 20;

std::vector<Vector> zigzag(int lines, double height_mm, double pitch_mm) {
  std::vector<Vector> corners{{-40, 0, 0}};
  for (int i = 1; i <= lines; ++i) corners.push_back({-40 + pitch_mm * i, i % 2 == 0 ? -height_mm : height_mm, 0});
  return corners;
}

}  // namespace

void zigzag_rows(Figures& figures, const Extent&) {
  double time_s = 0, least = 1e300, longest_ms = 0, worst_limits = 0, worst_off = 0;
  std::string where, where_long, failures;
  for (const double jerk : {1000.0, 10'000.0, 50'000.0}) {
    for (const double pitch_mm : {0.02, 0.05, 0.1, 0.2}) {
      for (const double tolerance_mm : {0.005, 0.05, 0.2}) {
        const Program program{zigzag(399, 0.17, pitch_mm), tolerance_mm};
        const std::string name = "pitch " + std::to_string(pitch_mm) + " mm, jerk " + std::to_string(jerk) +
                                 ", tolerance " + std::to_string(tolerance_mm) + " mm";
        const auto done = machine(program, bench_xyz(1000, jerk));
        if (!done) {
          failures += name + ": " + done.error() + "; ";
          continue;
        }
        time_s += done->time_s;
        const double times = done->time_s / done->planning_s;
        if (times < least) {
          least = times;
          where = name;
        }
        if (1000 * done->longest_step_s > longest_ms) {
          longest_ms = 1000 * done->longest_step_s;
          where_long = name;
        }
        worst_limits = std::max(worst_limits, done->limits);
        worst_off = std::max(worst_off, done->deviation_mm / tolerance_mm);
      }
    }
  }
  if (!failures.empty()) figures.missing("zigzags", ">= 5", "times the motion", failures);
  figures.inform("zigzags_time", time_s, "s", "all together");
  figures.at_least("zigzags_planned", least, kTimesFaster, "times the motion", where);
  figures.at_most("zigzags_longest_step", longest_ms, kLongestStep_ms, "ms", where_long);
  figures.at_most("zigzags_limits", worst_limits, 1.001, "of limit");
  figures.at_most("zigzags_off_the_lines", worst_off, 1, "of tolerance");
}

}  // namespace rmac::bench
