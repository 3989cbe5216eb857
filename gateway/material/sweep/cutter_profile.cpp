#include "gateway/material/sweep/cutter_profile.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {

using Kind = ProfilePiece::Kind;

double ProfilePiece::lever() const noexcept {
  if (kind == Kind::Ball) return 0;
  if (kind == Kind::RoundedDisc) return bottom_radius;  // its rounding is the same in every direction
  return std::hypot(std::max(bottom_radius, top_radius), height / 2);
}

std::vector<ProfilePiece> cutting_profile(const ToolShape& shape) {
  std::vector<ProfilePiece> pieces;
  const double radius = shape.dc / 2, corner = std::min(shape.re, radius);
  if (corner > 0 && corner == radius) {
    pieces.push_back({.kind = Kind::Ball, .middle = corner, .rounded = corner});
  } else if (corner > 0) {
    pieces.push_back(
        {.kind = Kind::RoundedDisc, .middle = corner, .bottom_radius = radius - corner, .rounded = corner});
  }
  if (shape.lcf > corner) {
    pieces.push_back({.kind = Kind::Cone,
                      .middle = (corner + shape.lcf) / 2,
                      .bottom_radius = radius,
                      .top_radius = radius,
                      .height = shape.lcf - corner});
  }
  return pieces;
}

std::vector<ProfilePiece> profile_of(const std::vector<ConeShape>& sections, double from_mm, double below_mm) {
  std::vector<ProfilePiece> pieces;
  for (const ConeShape& section : sections) {
    const double middle = from_mm + section.height / 2;
    from_mm += section.height;
    const double bottom = section.bottom_radius - below_mm, top = section.top_radius - below_mm;
    const double height = section.height - 2 * below_mm;
    if (height <= 0 || std::max(bottom, top) <= 0) continue;
    pieces.push_back({.kind = Kind::Cone,
                      .middle = middle,
                      .bottom_radius = std::max(bottom, 0.0),
                      .top_radius = std::max(top, 0.0),
                      .height = height});
  }
  return pieces;
}

}  // namespace rmac::gateway
