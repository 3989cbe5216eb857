#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "clients/legacy/program/arc_geometry.hpp"
#include "clients/legacy/program/vectors.hpp"

namespace rmac::gcode {

[[nodiscard]] inline legacy::Point& image_of(legacy::Placement& placement, std::size_t axis) {
  return axis == 0 ? placement.x : axis == 1 ? placement.y : placement.z;
}

/// What A, B and C turn: about X, Y and Z.
[[nodiscard]] constexpr legacy::Plane plane_of(char letter) {
  return letter == 'A' ? legacy::Plane{1, 2, 0} : letter == 'B' ? legacy::Plane{2, 0, 1} : legacy::Plane{};
}

/// Counter-clockwise in a plane, about the origin; exact at multiples of a right angle.
[[nodiscard]] inline legacy::Placement turn_about_normal(const legacy::Plane& plane, double degrees) {
  constexpr double kRight = 90;
  const double rights = degrees / kRight, radians = degrees * std::numbers::pi / 180;
  double sine = std::sin(radians), cosine = std::cos(radians);
  if (rights == std::round(rights)) {
    constexpr std::array<double, 5> kSines{0, 1, 0, -1, 0};
    const auto quadrant = static_cast<std::size_t>(std::fmod(std::fmod(rights, 4) + 4, 4));
    sine = kSines.at(quadrant);
    cosine = kSines.at(quadrant + 1);
  }
  legacy::Placement result;
  image_of(result, plane.first).at(plane.first) = cosine;
  image_of(result, plane.first).at(plane.second) = sine;
  image_of(result, plane.second).at(plane.first) = -sine;
  image_of(result, plane.second).at(plane.second) = cosine;
  return result;
}

}  // namespace rmac::gcode
