#include "rmac/fieldbus/bristle_friction.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus {

BristleFriction::BristleFriction(const FrictionParameters& parameters) noexcept
    : parameters_(parameters),
      stiffness_nm_rad_(parameters.coulomb_nm > 0 ? parameters.coulomb_nm / parameters.presliding_rad : 0) {}

void BristleFriction::begin(double speed_rad_s, double dt) noexcept {
  const double share = parameters_.stribeck_rad_s > 0 ? speed_rad_s / parameters_.stribeck_rad_s : 0;
  const double near_rest = std::exp(-share * share);
  bound_nm_ = parameters_.coulomb_nm + (parameters_.static_nm - parameters_.coulomb_nm) * near_rest;
  viscous_nm_rad_ = parameters_.viscous_nm_s / dt;
  damping_nm_rad_ = parameters_.damping_nm_s_rad * near_rest / dt;
}

BristleFriction::Bend BristleFriction::bend(double way_rad) const noexcept {
  if (stiffness_nm_rad_ == 0) return {};
  const double along = std::copysign(stiffness_nm_rad_ / bound_nm_, way_rad);
  const double elastic = parameters_.elastic_share;
  const double slides =
      std::clamp((along * (deflection_rad_ + way_rad / 2) - elastic) / (1 - elastic), 0.0, 1.0);  // (7)
  const double mean = (deflection_rad_ + way_rad / 2) / (1 + slides * along * way_rad / 2);       // (8)
  return {mean, std::max(0.0, 1 - slides * along * mean)};
}

double BristleFriction::torque_nm(double way_rad) const noexcept {
  const Bend now = bend(way_rad);
  return stiffness_nm_rad_ * now.mean_rad + (viscous_nm_rad_ + damping_nm_rad_ * now.share) * way_rad;  // (9)
}

}  // namespace rmac::fieldbus
