#include "rmac/fieldbus/simulated_plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::fieldbus {

namespace {

// Well below the current loop's lag.
constexpr double kLargestStepS = 25e-6;
// Below this (N·m, rpm) an exponential approach has arrived; going on would end in denormal numbers, which are slow.
constexpr double kSettled = 1e-12;
constexpr double kRadPerRpm = 2 * std::numbers::pi / 60;

double towards_zero(double value, double amount) noexcept {
  return std::copysign(std::max(std::abs(value) - amount, 0.0), value);
}

}  // namespace

double AxisPlantParameters::inertia_kg_m2() const noexcept {
  const double metres_per_radian = pitch_mm * 1e-3 / (2 * std::numbers::pi);
  return rotor_inertia_kg_m2 + screw_inertia_kg_m2 + table_mass_kg * metres_per_radian * metres_per_radian;
}

TwoMassParameters AxisPlantParameters::two_masses() const noexcept {
  // Assumed: static friction has gone at 1 mm/s of a screw of 5 mm, as with grease on roller guides.
  constexpr double kStribeckRadS = 12 * kRadPerRpm;
  // Assumed, of their own oscillation: bristles are damped by this, and a brake that is closed by more.
  constexpr double kBristleDamping = 0.3, kBrakeDamping = 0.7;
  constexpr double kElastic = 0.3, kBrakeElastic = 0.9;  // assumed: below, nothing creeps
  constexpr double kBrakeRad = 1e-3;                     // assumed: teeth and lining of a brake give way by so much

  const double motor = inertia_kg_m2() - load_inertia_kg_m2;
  const auto friction = [](double coulomb, double most, double presliding, double viscous, double inertia,
                           double damping, double elastic) {
    return FrictionParameters{.coulomb_nm = coulomb,
                              .static_nm = most,
                              .presliding_rad = presliding,
                              .elastic_share = elastic,
                              .stribeck_rad_s = kStribeckRadS,
                              .viscous_nm_s = viscous,
                              .damping_nm_s_rad = 2 * damping * std::sqrt(coulomb / presliding * inertia)};
  };
  const auto share = [&](double of, double inertia) {
    return friction(of * coulomb_nm, of * static_nm, presliding_rad, of * viscous_nm_s, inertia, kBristleDamping,
                    kElastic);
  };
  const double together = motor * load_inertia_kg_m2 / (motor + load_inertia_kg_m2);
  return {.motor_inertia_kg_m2 = motor,
          .load_inertia_kg_m2 = load_inertia_kg_m2,
          .stiffness_nm_rad = stiffness_nm_rad,
          .damping_nm_s_rad = 2 * damping_ratio * std::sqrt(stiffness_nm_rad * together),
          .play_rad = play_rad,
          .weight_nm = gravity_nm,
          .motor_friction = share(1 - friction_at_load, motor),
          .load_friction = share(friction_at_load, load_inertia_kg_m2),
          .brake = friction(brake_nm, brake_nm, kBrakeRad, 0, motor, kBrakeDamping, kBrakeElastic)};
}

AxisPlant::AxisPlant(const AxisPlantParameters& parameters) noexcept
    : parameters_(parameters), inertia_kg_m2_(parameters.inertia_kg_m2()), largest_step_s_(kLargestStepS) {
  if (!parameters.gives_way()) return;
  masses_.emplace(parameters.two_masses());
  largest_step_s_ = std::min(largest_step_s_, masses_->largest_step_s());
}

void AxisPlant::put_at(double angle_rad) noexcept {
  angle_rad_ = angle_rad;
  speed_rad_s_ = 0;
  if (masses_) masses_->put_at(angle_rad);
}

/// What the magnets make of it: ripple, and cogging, which is there without current, too.
double AxisPlant::shaft_nm() const noexcept {
  double torque = motor_nm_;
  if (parameters_.torque_ripple != 0)
    torque *= 1 + parameters_.torque_ripple * std::sin(parameters_.torque_ripple_periods * angle_rad_);
  if (parameters_.cogging != 0)
    torque += parameters_.cogging * parameters_.rated_torque_nm * std::sin(parameters_.cogging_periods * angle_rad_);
  return torque;
}

void AxisPlant::advance(double motor_nm, bool braked, double duration_s) noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / largest_step_s_ - 1e-9)));
  const double dt = duration_s / steps;
  const double bounded = std::clamp(motor_nm, -parameters_.peak_torque_nm, parameters_.peak_torque_nm);
  const double approach = -std::expm1(-dt / parameters_.torque_lag_s);
  for (int i = 0; i < steps; ++i) {
    motor_nm_ += (bounded - motor_nm_) * approach;
    if (std::abs(bounded - motor_nm_) < kSettled) motor_nm_ = bounded;
    step(braked, dt);
  }
}

void AxisPlant::step(bool braked, double dt) noexcept {
  if (masses_) {
    masses_->step(
        {.motor_nm = shaft_nm(), .load_nm = push_nm_ - parameters_.gravity_nm, .braked = braked, .contact = contact_},
        dt);
    angle_rad_ = masses_->motor_rad();
    speed_rad_s_ = masses_->motor_rad_s();
    return;
  }
  const double brake = braked ? parameters_.brake_nm : 0;
  const double driving = shaft_nm() - parameters_.gravity_nm + push_nm_ + contact_nm();
  if (speed_rad_s_ == 0 && std::abs(driving) <= parameters_.static_nm + brake) return;  // it sticks

  // Dry friction can stop the shaft within a step, never turn it round: what it takes away ends at zero. The viscous
  // part is implicit, so any step is stable. (Symplectic Euler; first order in dt.)
  const double pushed = speed_rad_s_ + driving * dt / inertia_kg_m2_;
  const double before = speed_rad_s_;
  speed_rad_s_ = towards_zero(pushed, (parameters_.coulomb_nm + brake) * dt / inertia_kg_m2_) /
                 (1 + parameters_.viscous_nm_s * dt / inertia_kg_m2_);
  // Coming through zero, the shaft rests for an instant and sticks unless the torque breaks it away.
  if (before * speed_rad_s_ < 0 && std::abs(driving) <= parameters_.static_nm + brake) speed_rad_s_ = 0;
  angle_rad_ += speed_rad_s_ * dt;
}

void SpindlePlant::advance(double wanted_rpm, bool powered, double duration_s) noexcept {
  const double bounded = powered ? std::clamp(wanted_rpm, -parameters_.max_speed_rpm, parameters_.max_speed_rpm) : 0;
  // Without power it runs down under a tenth of its torque.
  const double torque_bound = powered ? parameters_.max_torque_nm : parameters_.max_torque_nm / 10;
  const double rpm_per_nm = duration_s / (parameters_.inertia_kg_m2 * kRadPerRpm);
  const double load = speed_rpm_ == 0 ? 0 : std::copysign(load_nm_, speed_rpm_);
  const double approach = (bounded - speed_rpm_) * -std::expm1(-duration_s / parameters_.time_constant_s);
  const double motor = std::clamp(approach / rpm_per_nm + load, -torque_bound, torque_bound);
  const double before = speed_rpm_;
  speed_rpm_ += (motor - load) * rpm_per_nm;
  if (load != 0 && before * speed_rpm_ < 0) speed_rpm_ = 0;  // a load stops it, and does not turn it round
  if (std::abs(bounded - speed_rpm_) < kSettled) speed_rpm_ = bounded;
  torque_nm_ = powered ? motor : 0;
}

}  // namespace rmac::fieldbus
