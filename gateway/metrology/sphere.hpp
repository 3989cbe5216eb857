#pragma once

#include <span>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// How far points lie from the sphere that fits them, in mm.
struct FitQuality {
  std::size_t points = 0;
  double rms_mm = 0;
  double worst_mm = 0;  ///< largest absolute value
};

struct FittedSphere {
  Vector centre{};
  double radius_mm = 0;
  FitQuality quality;
};

/// The sphere through measured points, by least squares of their orthogonal distances (ISO 10360-6 calls it a Gaussian
/// associated feature). Points that leave a freedom of it are refused, and the message says which: held is what changes
/// the distances by more than 1 µm rms when it changes by 1 mm.
[[nodiscard]] Expected<FittedSphere> fit_sphere(std::span<const Vector> points);

}  // namespace rmac::gateway
