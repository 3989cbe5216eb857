#include "rmac/fieldbus/simulated_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rmac/motion/frame.hpp"

namespace rmac::fieldbus {
namespace {

/// Distance from a body that is made of bounds: how far outside of each, negative inside.
double from_bounds(double across, double along) noexcept {
  if (across <= 0 || along <= 0) return std::max(across, along);
  return std::hypot(across, along);
}

double from_block(const SimulatedPart::Block& block, const Vector& at) noexcept {
  double outside = 0;
  double inside = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double beyond = std::max(block.low[i] - at[i], at[i] - block.high[i]);
    outside = std::hypot(outside, std::max(beyond, 0.0));
    inside = std::max(inside, beyond);
  }
  return inside > 0 ? outside : inside;
}

double from_bore(const SimulatedPart::Bore& bore, const Vector& at) noexcept {
  const double across = std::hypot(at[0] - bore.x, at[1] - bore.y) - bore.radius;
  return from_bounds(across, std::max(bore.bottom - at[2], at[2] - bore.top));
}

}  // namespace

double SimulatedPart::distance(const Vector& point) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  const Vector in_part = apply_to_point(inverse(place), point);
  for (const Block& block : blocks) nearest = std::min(nearest, from_block(block, in_part));
  for (const Bore& bore : bores) nearest = std::max(nearest, -from_bore(bore, in_part));
  for (const Sphere& sphere : spheres) {
    const double from_center =
        std::hypot(point[0] - sphere.center[0], point[1] - sphere.center[1], point[2] - sphere.center[2]);
    nearest = std::min(nearest, from_center - sphere.radius);
  }
  return nearest;
}

}  // namespace rmac::fieldbus
