#pragma once

#include <algorithm>
#include <cstddef>

#include "rmac/motion/joint_mechanics.hpp"

namespace rmac {

/// What is to be added to where a drive shows its joint, mm or degrees: straight between the points of the table,
/// steady beyond its ends. Real-time safe.
[[nodiscard]] inline double pitch_error(const PitchErrors& pitch, double shown) noexcept {
  if (pitch.errors.size() < 2) return pitch.errors.empty() ? 0 : pitch.errors.front();
  const std::size_t last = pitch.errors.size() - 1;
  const double along = std::clamp((shown - pitch.first) / pitch.step, 0.0, static_cast<double>(last));
  const std::size_t index = std::min(static_cast<std::size_t>(along), last - 1);
  const double part = along - static_cast<double>(index);
  return pitch.errors[index] * (1 - part) + pitch.errors[index + 1] * part;
}

}  // namespace rmac
