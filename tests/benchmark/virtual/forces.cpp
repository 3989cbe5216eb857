#include "benchmark/virtual/forces.hpp"

#include <fmt/format.h>

#include <ctime>

#include "unit/gateway/forces/brute_force.hpp"

namespace rmac::bench {
namespace {

using namespace gateway;
using std::numbers::pi;

constexpr double kMostOff_percent = 5, kRpm = 6000, kDepth_mm = 6;
/// Al7075-T6 of etc/materials.json.
constexpr ForceCoefficients kMaterial{.ktc = 767.01, .krc = 168.8, .kac = 222, .kte = 27.7, .kre = 26.6, .kae = 0.7};
constexpr ToothFeed kFeed{.across_mm = 0.08, .along_mm = 0};

ToolShape tool(double re) {
  return {.dc = 12, .re = re, .apmx = 20, .lcf = 20, .oal = 60, .zefp = 4, .fha = 30, .shank = {}, .holder = {}};
}

/// The farthest that a mean or a peak is from the sum's, % of the peak.
double off_percent(const ToolShape& shape, const std::vector<EngagedSlice>& slices) {
  const auto wanted = test::brute_force(shape, kMaterial, slices, kFeed, 7200, 400);
  const TurnForces found = forces_over_turn(EndMill::of(shape).value(), kMaterial, slices, kFeed, kRpm).value();
  double most = 0;
  const OverTurn* const values[]{&found.x_n, &found.y_n, &found.z_n, &found.torque_nm};
  for (std::size_t i = 0; i < 4; ++i) {
    const double peak = std::abs(wanted.peak(i));
    most = std::max(most, std::abs(values[i]->mean - wanted.mean(i)) / peak);
    most = std::max(most, std::abs(values[i]->peak - wanted.peak(i)) / peak);
  }
  return 100 * most;
}

}  // namespace

void measure_forces(Figures& figures) {
  struct Case {
    const char* name;
    Arc arc;
  };
  for (const Case& each :
       {Case{"slot", {0, pi}}, Case{"half immersion, up", {0, pi / 2}}, Case{"half immersion, down", {pi / 2, pi}}}) {
    double off = 0;
    for (const double re : {0.0, 2.0, 6.0}) {
      off = std::max(off, off_percent(tool(re), {{.from_mm = 0, .to_mm = kDepth_mm, .arcs = {each.arc}}}));
    }
    figures.at_most(fmt::format("forces: {}", each.name), off, kMostOff_percent, "% off",
                    "means and peaks of flat, bull-nose and ball end, 12 mm, 4 teeth, 30°, 6 mm deep");
  }
  constexpr int kTurns = 200;
  const EndMill mill = EndMill::of(tool(6)).value();
  const std::vector<EngagedSlice> slices{{.from_mm = 0, .to_mm = kDepth_mm, .arcs = {{0, pi}}}};
  const std::clock_t began = std::clock();
  for (int i = 0; i < kTurns; ++i) static_cast<void>(forces_over_turn(mill, kMaterial, slices, kFeed, kRpm + i));
  figures.inform("forces: a turn", 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / kTurns, "ms",
                 "a ball, one slice");
}

}  // namespace rmac::bench
