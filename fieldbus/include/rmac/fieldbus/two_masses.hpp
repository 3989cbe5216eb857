#pragma once

#include "rmac/fieldbus/bristle_friction.hpp"

namespace rmac::fieldbus {

/// What a table or a head pushes against, seen at the motor shaft: a spring and a damper at angles below `surface_rad`.
struct PlantContact {
  double stiffness_nm_rad = 0;  ///< 0: nothing is there
  double damping_nm_s_rad = 0;
  double surface_rad = 0;
  bool clamps = false;  ///< it pulls as well, at angles above: the load is caught there, as in a guide that has seized

  /// What it turns a shaft with that stands and turns so; never negative unless it clamps, for nothing else pulls.
  [[nodiscard]] double torque_nm(double angle_rad, double speed_rad_s) const noexcept;
};

/// Everything at the motor shaft.
struct TwoMassParameters {
  double motor_inertia_kg_m2 = 0;
  double load_inertia_kg_m2 = 0;
  double stiffness_nm_rad = 0;  ///< of the spring between the two
  double damping_nm_s_rad = 0;  ///< beside it
  double play_rad = 0;          ///< in which the spring does nothing
  /// What pulls the load towards smaller angles as the zero of its angle is set: it is where the load hangs while the
  /// motor stands at its own.
  double weight_nm = 0;
  FrictionParameters motor_friction{};
  FrictionParameters load_friction{};
  FrictionParameters brake{};  ///< at the motor, while it is closed

  /// Of the free oscillation, motor against load, without damping and play.
  [[nodiscard]] double resonance_rad_s() const noexcept;
  /// By which the motor is ahead of a load that hangs on it by its weight: through the play, and what the spring gives.
  [[nodiscard]] double hanging_rad() const noexcept;
};

/// What acts from outside in one step.
struct TwoMassTorques {
  double motor_nm = 0;
  double load_nm = 0;
  bool braked = false;
  PlantContact contact{};  ///< at the load
};

/// Motor and load with a spring and play between them, each with friction. The implicit midpoint rule with the spring's
/// discrete gradient: stable at any stiffness, and energy never grows unless something from outside gives it
/// (docs/derivations/two-masses.md). Real-time safe.
class TwoMasses {
 public:
  explicit TwoMasses(const TwoMassParameters& parameters) noexcept;

  /// One step of at most `largest_step_s()`.
  void step(const TwoMassTorques& torques, double dt) noexcept;
  /// Beyond it frequencies would be wrong by more than a thousandth.
  [[nodiscard]] double largest_step_s() const noexcept;

  [[nodiscard]] double motor_rad() const noexcept { return motor_rad_; }
  [[nodiscard]] double load_rad() const noexcept { return motor_rad_ - (twist_rad_ - hanging_rad_); }
  [[nodiscard]] double motor_rad_s() const noexcept { return motor_rad_s_; }
  [[nodiscard]] double load_rad_s() const noexcept { return load_rad_s_; }
  /// At rest: the load hangs by its weight, or is in the middle of the play, and no friction is bent.
  void put_at(double angle_rad) noexcept;
  /// Of motion, spring and bristles.
  [[nodiscard]] double energy_j() const noexcept;

 private:
  [[nodiscard]] double wound(double twist_rad) const noexcept;

  TwoMassParameters parameters_;
  BristleFriction motor_friction_;
  BristleFriction load_friction_;
  BristleFriction brake_;
  double motor_rad_ = 0;
  double hanging_rad_;
  double twist_rad_;  ///< by which the spring and its play are turned; kept apart, for it is small
  double motor_rad_s_ = 0;
  double load_rad_s_ = 0;
};

}  // namespace rmac::fieldbus
