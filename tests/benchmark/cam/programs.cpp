// Ten thousand seeded programs of all kinds: how long planning takes, and what it must keep.
#include <algorithm>
#include <string>
#include <vector>

#include "program.hpp"
#include "random_programs.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

constexpr double kTimesFaster = 5;
constexpr double kLongestStep_ms = 20;
/// What a judge's polyline of a curve may miss it by, and rounding, mm.
constexpr double kRounding_mm = 5e-4;
constexpr std::size_t kNamed = 5;

/// The worst of something, and which program it was.
struct Worst {
  double value = 0;
  std::string where;
  void take(double other, const std::string& name) {
    if (!(other > value)) return;
    value = other;
    where = name;
  }
};

}  // namespace

void program_rows(Figures& figures, const Extent& extent) {
  const int count = extent.cases(10'000, 300);
  Worst planning, step, limits, off;
  int slow = 0, refused = 0, long_steps = 0;
  double motion_s = 0, planning_s = 0;
  std::vector<std::string> endless;
  for (int i = 0; i < count; ++i) {
    const RandomProgram program = random_program(1'000'000 * extent.seed + static_cast<unsigned long>(i));
    const auto done = machine(program.moves, program.model);
    if (!done) {
      if (done.error().refused) {
        ++refused;
      } else {
        endless.push_back(program.name);
      }
      continue;
    }
    motion_s += done->time_s;
    planning_s += done->planning_s;
    planning.take(done->planning_s / done->time_s, program.name);
    slow += done->planning_s * kTimesFaster > done->time_s ? 1 : 0;
    step.take(1000 * done->longest_step_s, program.name);
    long_steps += 1000 * done->longest_step_s > kLongestStep_ms ? 1 : 0;
    limits.take(done->limits, program.name);
    off.take(done->deviation_mm / (program.tolerance_mm + kRounding_mm), program.name);
  }
  std::string names;
  for (std::size_t i = 0; i < std::min(endless.size(), kNamed); ++i) names += endless[i] + "; ";
  const std::string note = std::to_string(count) + " programs, seed " + std::to_string(extent.seed);
  figures.inform("programs_refused", refused, "programs", note);
  figures.at_most("programs_endless", static_cast<double>(endless.size()), 0, "programs", names + note);
  figures.inform("programs_planned", motion_s / planning_s, "times the motion", "all together");
  figures.at_least("programs_planned_slowest", 1 / planning.value, kTimesFaster, "times the motion", planning.where);
  figures.inform("programs_slow", slow, "programs", "planned less than 5 times as fast as they move");
  figures.at_most("programs_longest_step", step.value, kLongestStep_ms, "ms", step.where);
  figures.inform("programs_long_steps", long_steps, "programs", "with a step of more than 20 ms");
  figures.at_most("programs_limits", limits.value, 1.001, "of limit", limits.where);
  figures.at_most("programs_off", off.value, 1, "of tolerance", off.where);
}

}  // namespace rmac::bench
