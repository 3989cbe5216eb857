#include <cmath>
#include <random>
#include <string>

#include "rows.hpp"
#include "unit/drivers/force_on_mill.hpp"

namespace rmac::bench {

using namespace mill_test;

namespace {

constexpr fieldbus::SimulatedContact kSheet{
    .surface_mm = -3, .stiffness_n_mm = 1000, .slope = 0.005, .wave_mm = 0.02, .wave_length_mm = 50};

void friction_stir_rows(Figures& figures) {
  const char* const note = "friction-stir-like pass of 40 mm at 600 mm/min, sheet of 1000 N/mm that rises and waves";
  const ForcePass rigid = ForceOnMill().press_and_go(kSheet);
  figures.at_most("contact_force_error_rms_rigid_axes", 100 * rigid.rms_share, 2, "% of 200 N", note);
  figures.at_most("torque_step_where_force_ends", 100 * rigid.release_torque_step, 1, "% of rated",
                  "rigid axes; position control takes over");
  const ForcePass pass = ForceOnMill({.as_it_comes = true}).press_and_go(kSheet);
  figures.at_most("contact_force_error", 100 * pass.worst_share, 2, "% of 200 N", note);
  figures.inform("contact_force_settles", 1e3 * pass.settled_s, "ms", "from contact until within 2 %");
}

/// 20 N while it slides at 20 mm/s, dwells of all lengths before, parts that ring for a while and drives on CAN too.
struct SmallForce {
  double pass = 0, rest = 0, settled_ms = 0, overshoot_n = 0;
  int faults = 0;
};

SmallForce small_force(double stiffness, int cases, std::mt19937& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  SmallForce worst;
  for (int i = 0; i < cases; ++i) {
    ForceOnMill mill({.force_n = 20,
                      .dwell_s = between(0, 3),
                      .speed_mm_s = 20,
                      .answer_delay = 2 * (i % 2),
                      .as_it_comes = true,
                      .seed = random()});
    const ForcePass pass = mill.press_and_go({.surface_mm = between(-4, -1),
                                              .stiffness_n_mm = stiffness,
                                              .damping_n_s_mm = std::exp(between(std::log(0.1), std::log(2.0))),
                                              .slope = between(-1e-4, 1e-4)});
    worst.pass = std::max(worst.pass, 100 * pass.rms_share);
    worst.rest = std::max(worst.rest, 100 * pass.rest_rms_share);
    worst.settled_ms = std::max(worst.settled_ms, 1e3 * pass.settled_s);
    worst.overshoot_n = std::max(worst.overshoot_n, pass.overshoot_n);
    worst.faults += mill.failed() ? 1 : 0;
  }
  return worst;
}

}  // namespace

void force_rows(Figures& figures) {
  friction_stir_rows(figures);
  std::mt19937 random(77);
  for (const int stiffness : {200, 1000, 5000, 20'000, 50'000}) {
    constexpr int kCases = 30;
    const SmallForce worst = small_force(stiffness, kCases, random);
    const std::string at = "_" + std::to_string(stiffness) + "_n_mm";
    const std::string note =
        "20 N, worst of " + std::to_string(kCases) + ": dwells, encoders, damping, drives a cycle late";
    const std::optional<double> most = stiffness > 20'000 ? std::nullopt : std::optional(2.0);
    const auto row = [&](const std::string& name, double value) {
      if (most) {
        figures.at_most(name + at, value, *most, "% rms", note);
      } else {
        figures.inform(name + at, value, "% rms", note);
      }
    };
    row("force_sliding", worst.pass);
    row("force_at_rest", worst.rest);
    figures.at_most("force_faults" + at, worst.faults, 0, "faults", note);
    figures.inform("force_overshoot" + at, worst.overshoot_n, "N", note);
  }
}

}  // namespace rmac::bench
