#include "joins/corner_shape.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rmac {
namespace {

/// Distance from the corner's lines, its first and its second derivative, on the half before the corner.
struct Half {
  double d = 0, d1 = 0, d2 = 0;

  void go(double slope, double length) noexcept {
    d += length * (d1 + length * (d2 / 2 + length * slope / 6));
    d1 += length * (d2 + length * slope / 2);
    d2 += length * slope;
  }
};

CornerShape measured(double lobe, double flat) {
  Half half;
  half.go(-1, lobe);
  const Half turned = half;
  const double rise = 1 - lobe - flat;
  half.go(1, rise);
  half.go(0, flat);
  // On the rise the distance is least where its derivative returns to zero.
  double least = 0;
  if (lobe > 0) {
    Half lowest = turned;
    lowest.go(1, -turned.d2 + std::sqrt(turned.d2 * turned.d2 - 2 * turned.d1));
    least = -lowest.d;
  }
  const double turn = 2 * half.d1;
  CornerShape shape;
  shape.lobe = lobe;
  shape.flat = flat;
  shape.acceleration = std::max(half.d2, lobe) / turn;
  shape.jerk_far = 1 / turn;
  shape.jerk_near = -1 / turn;
  shape.deviation = std::max(half.d, least) / turn;
  return shape;
}

/// f''' = c before the corner and ratio · c behind it, with f(1) = 1; ratio -1 is constant speed, and 1 one cubic.
CornerShape braking(double ratio) {
  const double c = 6 / (7 + ratio);
  CornerShape shape;
  shape.entry_speed = c * (3 + ratio) / 2;
  shape.entry_acceleration = c * (1 + ratio);
  shape.acceleration = c;
  shape.jerk_far = c;
  shape.jerk_near = ratio * c;
  shape.deviation = c / 6;
  return shape;
}

}  // namespace

std::span<const CornerShape> corner_shapes() {
  static const std::vector<CornerShape> shapes = [] {
    std::vector<CornerShape> all;
    for (const double flat : {0.0, 0.1, 0.2, 0.35, 0.5, 0.7}) {
      all.push_back(measured(0, flat));
      // Longer lobes turn the tangent less: past the length that makes them as deep as the corner's rounding is high,
      // nothing is gained.
      for (double lobe = 0.02; lobe < 0.25 * (1 - flat); lobe += 0.02) {
        const CornerShape shape = measured(lobe, flat);
        if (!(shape.jerk_far > 0) || shape.deviation > all.back().deviation) break;
        all.push_back(shape);
      }
    }
    for (const double ratio : {-0.5, 0.0, 0.5, 1.0}) all.push_back(braking(ratio));
    return all;
  }();
  return shapes;
}

}  // namespace rmac
