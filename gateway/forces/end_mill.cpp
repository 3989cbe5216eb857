#include "gateway/forces/end_mill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::gateway {

using std::numbers::pi;

Expected<EndMill> EndMill::of(const ToolShape& shape) {
  if (shape.zefp <= 0) {
    return failure(MinorCode::InvalidParameterValue,
                   "its Shape does not say how many teeth it has; give ZEFP in the tool table");
  }
  EndMill mill;
  mill.radius_mm_ = shape.dc / 2;
  mill.corner_mm_ = std::min(shape.re, mill.radius_mm_);
  mill.length_mm_ = shape.lcf;
  mill.teeth_ = shape.zefp;
  mill.lag_per_mm_ = std::tan(shape.fha * pi / 180) / mill.radius_mm_;
  return mill;
}

EndMill::Place EndMill::at(double profile_mm) const noexcept {
  Place place;
  if (const double corner = corner_ends_mm(); profile_mm < corner) {
    const double k = std::max(0.0, profile_mm) / corner_mm_;
    place.sin_k = std::sin(k), place.cos_k = std::cos(k);
    place.z_mm = corner_mm_ * (1 - place.cos_k);
    place.radius_mm = radius_mm_ - corner_mm_ * (1 - place.sin_k);
  } else {
    place.z_mm = corner_mm_ + profile_mm - corner;
    place.radius_mm = radius_mm_;
  }
  place.edge_per_profile = std::hypot(1.0, place.radius_mm * lag_per_mm_ * place.sin_k);
  return place;
}

double EndMill::profile_at(double z_mm) const noexcept {
  if (z_mm >= corner_mm_) return corner_ends_mm() + z_mm - corner_mm_;
  return corner_mm_ * std::acos(std::clamp(1 - z_mm / corner_mm_, -1.0, 1.0));
}

double EndMill::corner_ends_mm() const noexcept {
  return corner_mm_ * pi / 2;
}

}  // namespace rmac::gateway
