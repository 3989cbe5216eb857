#pragma once

#include <cstdint>
#include <numbers>
#include <variant>
#include <vector>

#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::mill_test {

inline constexpr double kRadPerMm = 2 * std::numbers::pi / 5;

/// DMACXYZ with axes of two masses: everything that docs/simulated-bus.md assumes of it, and this frequency.
inline std::vector<fieldbus::SimulatedAxis> honest_axes(double hz, double damping, std::uint64_t seed) {
  std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes();
  for (fieldbus::SimulatedAxis& axis : axes) {
    auto* const plant = std::get_if<fieldbus::AxisPlantParameters>(&axis);
    if (plant == nullptr) continue;
    const double whole = plant->inertia_kg_m2();
    plant->load_inertia_kg_m2 = plant->table_mass_kg * 1e-6 / (kRadPerMm * kRadPerMm);
    const double motor = whole - plant->load_inertia_kg_m2;
    const double natural = 2 * std::numbers::pi * hz;
    plant->stiffness_nm_rad = natural * natural * motor * plant->load_inertia_kg_m2 / whole;
    plant->damping_ratio = damping;
    plant->presliding_rad = 0.010 * kRadPerMm;
    plant->cogging = 0.02;
    plant->torque_ripple = 0.01;
    plant->encoder.noise_counts = 1;
    plant->encoder.interpolation_counts = 2;
    plant->encoder.seed = seed++;
  }
  return axes;
}

}  // namespace rmac::mill_test
