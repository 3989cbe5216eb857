#pragma once

#include <span>
#include <vector>

#include "gateway/forces/turn_forces.hpp"
#include "unit/gateway/chatter/milling_in_time.hpp"

namespace rmac::gateway::test {

inline constexpr ForceCoefficients kMaterial{.ktc = 800, .krc = 300, .kac = 150, .kte = 28, .kre = 31, .kae = 1.4};
inline constexpr double kPi = std::numbers::pi;
inline constexpr Arc kSlot{0, kPi}, kUp{0, kPi / 2}, kDown{kPi / 2, kPi};

/// As the product has them.
inline ChipStiffness stiffness_of(const StraightTeeth& teeth, double helix_deg = 0) {
  const ToolShape shape{.dc = 12,
                        .re = 0,
                        .apmx = 50,
                        .lcf = 50,
                        .oal = 60,
                        .zefp = teeth.count,
                        .fha = helix_deg,
                        .shank = {},
                        .holder = {}};
  const std::vector<EngagedSlice> slices{{.from_mm = 0, .to_mm = teeth.depth_mm, .arcs = {teeth.arc}}};
  return chip_stiffness(EndMill::of(shape).value(), teeth.material, slices, {.across_mm = 0.05, .along_mm = 0}, 72)
      .value();
}

inline std::vector<VibrationMode> modes_of(std::span<const Oscillator> oscillators) {
  std::vector<VibrationMode> modes;
  for (const Oscillator& one : oscillators) modes.push_back(one.mode());
  return modes;
}

}  // namespace rmac::gateway::test
