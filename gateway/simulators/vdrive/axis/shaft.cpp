#include "gateway/simulators/vdrive/axis/shaft.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::vdrive {
namespace {

constexpr double kStandingRevolutionsPerS = 0.02;

}  // namespace

double Shaft::counts_per_radian() const noexcept {
  return mechanics_.encoder.counts_per_revolution / (2 * std::numbers::pi);
}

double Shaft::angle() const noexcept {
  return plant_.angle_rad() * counts_per_radian();
}

double Shaft::velocity() const noexcept {
  return plant_.speed_rad_s() * counts_per_radian();
}

double Shaft::position_at(double angle) const noexcept {
  return std::floor(angle) + offset_ + shift_;
}

double Shaft::turn_of(double angle, double index) const noexcept {
  return std::floor((angle - index) / mechanics_.encoder.counts_per_revolution);
}

bool Shaft::stands() const noexcept {
  return std::abs(velocity()) < kStandingRevolutionsPerS * mechanics_.encoder.counts_per_revolution;
}

double Shaft::nm_per_count() const noexcept {
  return mechanics_.inertia_kg_m2() / counts_per_radian();
}

double Shaft::nm_to_rest(double dt) const noexcept {
  return -plant_.speed_rad_s() * mechanics_.inertia_kg_m2() / dt;
}

double Shaft::deceleration(Braking by, double slow_down, double quick_stop) const noexcept {
  const double possible = mechanics_.rated_torque_nm / mechanics_.inertia_kg_m2() * counts_per_radian();
  if (by == Braking::Torque) return possible;
  return std::min(by == Braking::SlowDown ? slow_down : quick_stop, possible);
}

}  // namespace rmac::vdrive
