#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "rmac/fieldbus/simulated_encoder.hpp"
#include "rmac/fieldbus/two_masses.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus {

/// Mechanics and motor of one simulated axis, seen at the motor shaft. The default is a small table axis: a 100 W motor
/// on a ball screw of 5 mm pitch.
struct AxisPlantParameters {
  // Yaskawa SGMAH-01A with holding brake, Sigma-II series user's manual, 3.1.1.
  double rated_torque_nm = 0.318;
  double peak_torque_nm = 0.955;
  double rotor_inertia_kg_m2 = 0.0364e-4 + 0.0085e-4;
  double max_speed_rpm = 5000;
  // The same series' encoder of 17 bits; which encoder a machine has is a choice of its builder, so: assumed.
  EncoderParameters encoder;
  // Assumed: screw of 12 mm diameter and 300 mm length, table with vice and part.
  double screw_inertia_kg_m2 = 4.8e-6;
  double pitch_mm = 5;
  double table_mass_kg = 20;
  double viscous_nm_s = 1.0e-4;  ///< assumed: 0.03 N·m of grease and seals at 3000 rpm
  double coulomb_nm = 0.015;     ///< assumed: preloaded nut and wipers, 19 N at the table
  double static_nm = 0.018;      ///< assumed: 1.2 times the sliding friction, before it breaks away
  double gravity_nm = 0;         ///< load that pulls towards negative angles; 0 for a horizontal axis. Where it hangs
                                 ///< by that is where it stands: the zero was set so
  double brake_nm = 0.318;       ///< assumed: a holding brake holds the rated torque
  // Where the limit switches close, which the drive tells as bits 0 and 1 of its inputs: there are none by default.
  double negative_switch_rad = -std::numeric_limits<double>::infinity();
  double positive_switch_rad = std::numeric_limits<double>::infinity();
  // What an axis does beyond a rigid one. Nothing of it is there unless it is said.
  double stiffness_nm_rad = 0;        ///< between motor and load; 0: they are one
  double load_inertia_kg_m2 = 0;      ///< of the whole, what is behind the spring
  double damping_ratio = 0.02;        ///< assumed: of the free oscillation, motor against load
  double play_rad = 0;                ///< between motor and load
  double friction_at_load = 0.5;      ///< assumed: share of the friction that guides and wipers have
  double presliding_rad = 0.00063;    ///< assumed: 0.5 µm at the table, before friction slides
  double cogging = 0;                 ///< amplitude, share of the rated torque
  double cogging_periods = 60;        ///< assumed: a turn; the least common multiple of 12 slots and 10 poles
  double torque_ripple = 0;           ///< amplitude, share of the torque that the motor gives
  double torque_ripple_periods = 30;  ///< assumed: a turn; six times five pole pairs
  // Current loop of the drive, as a first-order lag.
  double torque_lag_s = 0.0002;                  ///< assumed: 800 Hz of current-loop bandwidth
  DriveMode mode = DriveMode::CyclicSyncTorque;  ///< in which the drive is used; velocity and position are the others
  /// In which share the drive takes the velocity beside its positions from their differences, and from 60B1h.
  double own_velocity = 1;
  double told_velocity = 0;

  /// Of all that turns with the motor.
  [[nodiscard]] double inertia_kg_m2() const noexcept;
  [[nodiscard]] bool gives_way() const noexcept { return stiffness_nm_rad > 0; }
  /// Where it gives way.
  [[nodiscard]] TwoMassParameters two_masses() const noexcept;
};

/// Rotor, screw and table under motor torque, friction and gravity: one inertia, or two with a spring between them.
/// Real-time safe.
class AxisPlant {
 public:
  explicit AxisPlant(const AxisPlantParameters& parameters) noexcept;

  /// `motor_nm` is the torque wanted of the current loop; with `braked` the holding brake is closed.
  void advance(double motor_nm, bool braked, double duration_s) noexcept;

  /// Of the motor.
  [[nodiscard]] double angle_rad() const noexcept { return angle_rad_; }
  [[nodiscard]] double speed_rad_s() const noexcept { return speed_rad_s_; }
  /// Of the load, as angles of the motor shaft: where the table really is.
  [[nodiscard]] double load_rad() const noexcept { return masses_ ? masses_->load_rad() : angle_rad_; }
  [[nodiscard]] double load_rad_s() const noexcept { return masses_ ? masses_->load_rad_s() : speed_rad_s_; }
  [[nodiscard]] double motor_nm() const noexcept { return motor_nm_; }
  [[nodiscard]] bool has_play() const noexcept { return masses_ && parameters_.play_rad > 0; }
  [[nodiscard]] const AxisPlantParameters& parameters() const noexcept { return parameters_; }
  void put_at(double angle_rad) noexcept;
  /// Torque from outside on the load, such as of a collision.
  void push(double nm) noexcept { push_nm_ = nm; }
  void touch(const PlantContact& contact) noexcept { contact_ = contact; }
  /// What the contact turns the shaft with; never negative, for nothing pulls.
  [[nodiscard]] double contact_nm() const noexcept { return contact_.torque_nm(load_rad(), load_rad_s()); }

 private:
  void step(bool braked, double dt) noexcept;
  [[nodiscard]] double shaft_nm() const noexcept;

  AxisPlantParameters parameters_;
  double inertia_kg_m2_;
  double largest_step_s_;
  std::optional<TwoMasses> masses_;  ///< where it gives way
  double angle_rad_ = 0;
  double speed_rad_s_ = 0;
  double motor_nm_ = 0;
  double push_nm_ = 0;
  PlantContact contact_;
};

/// A spindle and its drive's own speed loop, as a first-order approach to the wanted speed within a torque bound.
struct SpindlePlantParameters {
  double max_speed_rpm = 1000;    ///< Table 4-1, DMACXYZ
  double max_torque_nm = 5;       ///< Table 4-1, DMACXYZ
  double inertia_kg_m2 = 0.01;    ///< assumed: spindle, chuck and tool
  double time_constant_s = 0.05;  ///< assumed
};

class SpindlePlant {
 public:
  explicit SpindlePlant(const SpindlePlantParameters& parameters) noexcept : parameters_(parameters) {}

  void advance(double wanted_rpm, bool powered, double duration_s) noexcept;
  [[nodiscard]] double speed_rpm() const noexcept { return speed_rpm_; }
  [[nodiscard]] double torque_nm() const noexcept { return torque_nm_; }
  /// What the motor gives, in per mille of the most that it can.
  [[nodiscard]] double torque_permille() const noexcept { return torque_nm_ * 1000 / parameters_.max_torque_nm; }
  /// Torque that holds it back while it turns, such as of a cut.
  void load(double nm) noexcept { load_nm_ = nm; }

 private:
  SpindlePlantParameters parameters_;
  double load_nm_ = 0;
  double speed_rpm_ = 0;
  double torque_nm_ = 0;
};

}  // namespace rmac::fieldbus
