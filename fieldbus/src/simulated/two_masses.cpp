#include "rmac/fieldbus/two_masses.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus {

namespace {

/// A force over one step, and how it changes with the way of that step.
struct Held {
  double nm = 0;
  double nm_rad = 0;
};

/// (4), (5): of a potential k d²/2 and a damper beside it, where `before` and `after` are d at the ends of the way.
Held elastic(double stiffness, double damping, double before, double after, double way, double dt) noexcept {
  // A way so short that the ratio would be rounding is all on one flank.
  constexpr double kNoWay = 1e-15;
  double share = before != 0 ? 1.0 : 0.0;
  if (std::abs(way) > kNoWay) share = std::clamp((after - before) / way, 0.0, 1.0);
  return {share * (stiffness * (before + after) / 2 + damping * way / dt), share * (stiffness / 2 + damping / dt)};
}

/// Over one step, torque of a contact on the load.
Held touched(const PlantContact& contact, double from_rad, double way, double dt) noexcept {
  if (contact.stiffness_nm_rad == 0) return {};
  double before = contact.surface_rad - from_rad;
  double after = before - way;
  if (contact.clamps) return elastic(contact.stiffness_nm_rad, contact.damping_nm_s_rad, before, after, -way, dt);
  before = std::max(0.0, before);
  after = std::max(0.0, after);
  if (before == 0 && after == 0) return {};
  const Held pressed = elastic(contact.stiffness_nm_rad, contact.damping_nm_s_rad, before, after, -way, dt);
  return pressed.nm > 0 ? Held{pressed.nm, pressed.nm_rad} : Held{};
}

}  // namespace

double PlantContact::torque_nm(double angle_rad, double speed_rad_s) const noexcept {
  if (stiffness_nm_rad == 0 || (angle_rad >= surface_rad && !clamps)) return 0;
  const double torque = stiffness_nm_rad * (surface_rad - angle_rad) - damping_nm_s_rad * speed_rad_s;
  return clamps ? torque : std::max(0.0, torque);
}

double TwoMassParameters::resonance_rad_s() const noexcept {
  return std::sqrt(stiffness_nm_rad * (1 / motor_inertia_kg_m2 + 1 / load_inertia_kg_m2));
}

double TwoMassParameters::hanging_rad() const noexcept {
  return weight_nm == 0 ? 0 : std::copysign(play_rad / 2, weight_nm) + weight_nm / stiffness_nm_rad;
}

TwoMasses::TwoMasses(const TwoMassParameters& parameters) noexcept
    : parameters_(parameters),
      motor_friction_(parameters.motor_friction),
      load_friction_(parameters.load_friction),
      brake_(parameters.brake),
      hanging_rad_(parameters.hanging_rad()),
      twist_rad_(hanging_rad_) {}

double TwoMasses::largest_step_s() const noexcept {
  return 0.1 / parameters_.resonance_rad_s();  // (ωh)²/12 is a thousandth
}

double TwoMasses::wound(double twist_rad) const noexcept {
  return std::copysign(std::max(std::abs(twist_rad) - parameters_.play_rad / 2, 0.0), twist_rad);
}

void TwoMasses::step(const TwoMassTorques& torques, double dt) noexcept {
  const double motor_inertia = 2 * parameters_.motor_inertia_kg_m2 / (dt * dt);
  const double load_inertia = 2 * parameters_.load_inertia_kg_m2 / (dt * dt);
  const double wound_before = wound(twist_rad_);
  double motor_way = motor_rad_s_ * dt, load_way = load_rad_s_ * dt;
  // Inertia outweighs all else in so short a step: each round leaves a hundredth of the error before, or less.
  constexpr int kMostRounds = 8;
  constexpr double kEnough = 1e-16;
  for (int round = 0; round < kMostRounds; ++round) {
    if (round < 2) {  // at the speed of the step, as well as the first round knows it
      motor_friction_.begin(motor_way / dt, dt);
      load_friction_.begin(load_way / dt, dt);
      if (torques.braked) brake_.begin(motor_way / dt, dt);
    }
    const double twisted = motor_way - load_way;
    const Held spring = elastic(parameters_.stiffness_nm_rad, parameters_.damping_nm_s_rad, wound_before,
                                wound(twist_rad_ + twisted), twisted, dt);
    const Held contact = touched(torques.contact, load_rad(), load_way, dt);
    const double brake_nm = torques.braked ? brake_.torque_nm(motor_way) : 0;
    // (2), as what is left over at either mass
    const double motor_left = motor_inertia * (motor_way - motor_rad_s_ * dt) + spring.nm +
                              motor_friction_.torque_nm(motor_way) + brake_nm - torques.motor_nm;
    const double load_left = load_inertia * (load_way - load_rad_s_ * dt) - spring.nm +
                             load_friction_.torque_nm(load_way) - contact.nm - torques.load_nm;
    const double a =
        motor_inertia + spring.nm_rad + motor_friction_.slope_nm_rad() + (torques.braked ? brake_.slope_nm_rad() : 0);
    const double d = load_inertia + spring.nm_rad + load_friction_.slope_nm_rad() + contact.nm_rad;
    const double determinant = a * d - spring.nm_rad * spring.nm_rad;
    const double motor_change = (d * motor_left + spring.nm_rad * load_left) / determinant;
    const double load_change = (spring.nm_rad * motor_left + a * load_left) / determinant;
    motor_way -= motor_change;
    load_way -= load_change;
    if (round > 0 && std::abs(motor_change) + std::abs(load_change) <= kEnough + 1e-14 * std::abs(motor_way)) break;
  }
  motor_friction_.slide(motor_way);
  load_friction_.slide(load_way);
  if (torques.braked) {
    brake_.slide(motor_way);
  } else {
    brake_.relax();
  }
  motor_rad_ += motor_way;
  twist_rad_ += motor_way - load_way;
  motor_rad_s_ = 2 * motor_way / dt - motor_rad_s_;
  load_rad_s_ = 2 * load_way / dt - load_rad_s_;
}

void TwoMasses::put_at(double angle_rad) noexcept {
  motor_rad_ = angle_rad;
  twist_rad_ = hanging_rad_;
  motor_rad_s_ = load_rad_s_ = 0;
  motor_friction_.relax();
  load_friction_.relax();
  brake_.relax();
}

double TwoMasses::energy_j() const noexcept {
  const double spring = wound(twist_rad_);
  return (parameters_.motor_inertia_kg_m2 * motor_rad_s_ * motor_rad_s_ +
          parameters_.load_inertia_kg_m2 * load_rad_s_ * load_rad_s_ + parameters_.stiffness_nm_rad * spring * spring) /
             2 +
         motor_friction_.energy_j() + load_friction_.energy_j() + brake_.energy_j();
}

}  // namespace rmac::fieldbus
