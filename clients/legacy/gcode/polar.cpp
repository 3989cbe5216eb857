#include "clients/legacy/gcode/polar.hpp"

#include <cmath>
#include <numbers>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

void require_plain(const Block& block, const Modes& modes, std::size_t place) {
  if (modes.plane.normal != 2) refuse(place, "@ and ^ are in the plane of X and Y; write G17 before them");
  for (const char letter : {'X', 'Y'}) {
    if (block.has(letter)) refuse(block.place(letter), "X or Y beside @ or ^; write one or the other");
  }
  if (block.g(GGroup::Once)) refuse(place, "@ and ^ go with moves and cycles alone; write X and Y");
}

std::size_t place_of_polar(const Block& block) {
  return (block.polar_radius() ? block.polar_radius() : block.polar_angle())->place;
}

PolarEnd from_zero(double distance, double angle_rad) {
  return {distance * std::cos(angle_rad), distance * std::sin(angle_rad)};
}

}  // namespace

PolarEnd polar_end(const Block& block, const Modes& modes, const ProgramTip& tip) {
  const auto &radius = block.polar_radius(), &angle = block.polar_angle();
  const std::size_t place = place_of_polar(block);
  if (!modes.incremental && radius && angle) return from_zero(radius->value, angle->value * kDegree);
  if (!(tip[0] && tip[1])) {
    refuse(place,
           "where the tool is now is not known, so neither is where this leads; write both distance and angle "
           "under G90, or a G0 to X, Y and Z before it");
  }
  const double distance = std::hypot(*tip[0], *tip[1]), now = std::atan2(*tip[1], *tip[0]);
  if (distance == 0 && (modes.incremental || !angle))
    refuse(place, "the tool is at zero, where it has no angle; write the angle under G90, or X and Y");
  if (!modes.incremental) return from_zero(radius ? radius->value : distance, angle ? angle->value * kDegree : now);
  return from_zero(distance + (radius ? radius->value : 0), now + (angle ? angle->value * kDegree : 0));
}

void place_polar(Block& block, const Modes& modes, const ProgramTip& tip) {
  if (!block.is_polar()) return;
  const std::size_t place = place_of_polar(block);
  require_plain(block, modes, place);
  const PolarEnd end = polar_end(block, modes, tip);
  const bool adds = modes.incremental;
  block.add_word('X', {end[0] - (adds ? *tip[0] : 0), place});
  block.add_word('Y', {end[1] - (adds ? *tip[1] : 0), place});
}

}  // namespace rmac::gcode
