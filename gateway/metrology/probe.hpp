#pragma once

#include <span>

#include "gateway/metrology/sphere.hpp"

// A touch probe with a ball tip: what it touches is a tip radius away from where its centre is. mm.

namespace rmac::gateway {

/// The point that was touched, along the surface's outward normal there: exact where the normal is.
[[nodiscard]] Vector touched_along_normal(const Vector& tip_centre, const Vector& outward_normal, double tip_radius_mm);

/// What the hits on a reference sphere say of a probe.
struct ProbeQualification {
  double tip_radius_mm = 0;
  Vector offset{};     ///< of the tip's centre from where it was taken to be, in the frame of the hits
  FitQuality quality;  ///< of the hits around the sphere: form of tip and sphere, and the probe's own errors
};

/// `tip_centres`: where the tip's centre was taken to be at each hit, not corrected for a radius. The sphere is known:
/// `centre`, `radius_mm`. Hits that do not hold the sphere are refused, and so is what makes the tip's radius 0 or
/// less.
[[nodiscard]] Expected<ProbeQualification> qualify_probe(std::span<const Vector> tip_centres, const Vector& centre,
                                                         double radius_mm);

}  // namespace rmac::gateway
