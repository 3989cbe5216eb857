#pragma once

#include <span>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

// Shapes through measured points, by least squares of their orthogonal distances (ISO 10360-6 calls them Gaussian
// associated features). mm. A set of points that does not hold a freedom of its shape is refused, and the message says
// which: held is what changes the distances by more than 1 µm rms when it changes by 1 mm.

namespace rmac::gateway {

/// How far the points are from the shape, in their order: positive outside of a sphere, circle or cylinder, and on the
/// side of a plane's normal.
struct FitQuality {
  std::vector<double> deviations_mm;
  double rms_mm = 0;
  double worst_mm = 0;  ///< largest absolute value
};
[[nodiscard]] FitQuality fit_quality(std::vector<double> deviations_mm);

struct FittedPlane {
  Vector point{};   ///< centroid of the points
  Vector normal{};  ///< unit; of the two, the one with the larger positive coordinate
  FitQuality quality;
};
struct FittedLine {
  Vector point{};
  Vector direction{};  ///< unit
  FitQuality quality;  ///< distances, none negative
};
struct FittedSphere {
  Vector centre{};
  double radius_mm = 0;
  FitQuality quality;
};
/// In the plane that fits the points; deviations are radial, within it.
struct FittedCircle {
  Vector centre{};
  Vector normal{};
  double radius_mm = 0;
  FitQuality quality;
};
struct FittedCylinder {
  Vector point{};  ///< of the axis, nearest to the centroid of the points
  Vector axis{};   ///< unit
  double radius_mm = 0;
  FitQuality quality;
};

[[nodiscard]] Expected<FittedPlane> fit_plane(std::span<const Vector> points);
[[nodiscard]] Expected<FittedLine> fit_line(std::span<const Vector> points);
[[nodiscard]] Expected<FittedSphere> fit_sphere(std::span<const Vector> points);
[[nodiscard]] Expected<FittedCircle> fit_circle(std::span<const Vector> points);
[[nodiscard]] Expected<FittedCylinder> fit_cylinder(std::span<const Vector> points);

}  // namespace rmac::gateway
