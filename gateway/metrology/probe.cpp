#include "gateway/metrology/probe.hpp"

#include "gateway/metrology/least_squares.hpp"

namespace rmac::gateway {

Vector touched_along_normal(const Vector& tip_centre, const Vector& outward_normal, double tip_radius_mm) {
  return from_eigen(to_eigen(tip_centre) - tip_radius_mm * to_eigen(outward_normal).normalized());
}

Expected<ProbeQualification> qualify_probe(std::span<const Vector> tip_centres, const Vector& centre,
                                           double radius_mm) {
  if (!(radius_mm > 0) || !std::isfinite(radius_mm)) {
    return refuse(fmt::format("the reference sphere's radius is {} mm, and must be above 0", radius_mm));
  }
  const auto sphere = fit_sphere(tip_centres);
  if (!sphere) return tl::unexpected(sphere.error());
  const double tip = sphere->radius_mm - radius_mm;
  if (!(tip > 0)) {
    return refuse(
        fmt::format("the hits lie on a sphere of radius {:.4f} mm, within the reference of {:.4f} mm: the "
                    "reference's radius is wrong, or the hits are corrected for a tip's radius already",
                    sphere->radius_mm, radius_mm));
  }
  return ProbeQualification{tip, from_eigen(to_eigen(centre) - to_eigen(sphere->centre)), sphere->quality};
}

}  // namespace rmac::gateway
