#pragma once

namespace rmac::fieldbus {

/// Dry and viscous friction of one body, in N·m and rad.
struct FrictionParameters {
  double coulomb_nm = 0;      ///< sliding
  double static_nm = 0;       ///< at rest, before it breaks away
  double presliding_rad = 0;  ///< over which the sliding friction would build up at the stiffness that rest begins with
  double elastic_share = 0;   ///< of the friction, up to which bristles only bend, and nothing creeps
  double stribeck_rad_s = 0;  ///< speed at which static friction has gone over into sliding
  double viscous_nm_s = 0;
  double damping_nm_s_rad = 0;  ///< of the bristles, near rest
};

/// Friction as of bristles that bend before they slide (Canudas de Wit et al., A New Model for Control of Systems with
/// Friction, 1995), and only bend as long as they are bent little (Dupont et al., Single State Elastoplastic Friction
/// Models, 2002), in the form of docs/derivations/two-masses.md, which takes energy at any speed and step. Within one
/// step: `begin`, then `torque_nm` of the ways that are tried, then `slide` by the one that is gone. Real-time safe.
class BristleFriction {
 public:
  explicit BristleFriction(const FrictionParameters& parameters) noexcept;

  /// A step of `dt`, at about this speed.
  void begin(double speed_rad_s, double dt) noexcept;
  /// What it holds back with, on average, over a step of this way; and how that changes with the way.
  [[nodiscard]] double torque_nm(double way_rad) const noexcept;
  [[nodiscard]] double slope_nm_rad() const noexcept {
    return stiffness_nm_rad_ / 2 + viscous_nm_rad_ + damping_nm_rad_;
  }
  void slide(double way_rad) noexcept { deflection_rad_ = 2 * bend(way_rad).mean_rad - deflection_rad_; }
  /// Nothing is bent.
  void relax() noexcept { deflection_rad_ = 0; }
  /// What the bristles hold.
  [[nodiscard]] double energy_j() const noexcept { return stiffness_nm_rad_ * deflection_rad_ * deflection_rad_ / 2; }

 private:
  struct Bend {
    double mean_rad = 0;  ///< deflection, over the way
    double share = 1;     ///< of the way, by which bristles bend; the rest slides
  };
  [[nodiscard]] Bend bend(double way_rad) const noexcept;

  FrictionParameters parameters_;
  double stiffness_nm_rad_;
  double deflection_rad_ = 0;
  double bound_nm_ = 0;        ///< friction at this step's speed
  double viscous_nm_rad_ = 0;  ///< a radian of way in this step
  double damping_nm_rad_ = 0;  ///< the same of bristles that bend
};

}  // namespace rmac::fieldbus
