#include <chrono>
#include <cmath>
#include <vector>

#include "rmac/fieldbus/simulated_plant.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

/// Microseconds that a simulated axis takes for a cycle of 1 ms while it goes to and fro.
std::vector<double> cycles_of(const fieldbus::AxisPlantParameters& axis) {
  constexpr int kCycles = 20'000;
  fieldbus::AxisPlant plant(axis);
  std::vector<double> microseconds;
  microseconds.reserve(kCycles);
  for (int i = 0; i < kCycles; ++i) {
    const double nm = 0.2 * std::sin(0.02 * i);
    const auto began = std::chrono::steady_clock::now();
    plant.advance(nm, false, 1e-3);
    const auto ended = std::chrono::steady_clock::now();
    microseconds.push_back(std::chrono::duration<double, std::micro>(ended - began).count());
  }
  return microseconds;
}

}  // namespace

void plant_rows(Figures& figures) {
  fieldbus::AxisPlantParameters axis;
  figures.at_most("plant_rigid_axis_p50", quantile(cycles_of(axis), 0.5), 5, "us", "an axis's cycle of 1 ms");
  axis.stiffness_nm_rad = 15.83;
  axis.load_inertia_kg_m2 = 1.267e-5;
  axis.presliding_rad = 0.0126;
  axis.play_rad = 0.006;
  axis.cogging = 0.02;
  axis.torque_ripple = 0.02;
  figures.at_most("plant_honest_axis_p50", quantile(cycles_of(axis), 0.5), 20, "us",
                  "the same with two masses, play, friction, cogging and ripple");
}

}  // namespace rmac::bench
