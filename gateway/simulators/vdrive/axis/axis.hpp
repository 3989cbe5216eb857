#pragma once

#include <functional>

#include "gateway/simulators/vdrive/axis/axis_parameters.hpp"
#include "gateway/simulators/vdrive/axis/axis_units.hpp"
#include "gateway/simulators/vdrive/axis/drive_loops.hpp"
#include "gateway/simulators/vdrive/axis/home_search.hpp"
#include "gateway/simulators/vdrive/axis/position_targets.hpp"
#include "gateway/simulators/vdrive/axis/power_states.hpp"
#include "gateway/simulators/vdrive/axis/profile.hpp"
#include "gateway/simulators/vdrive/axis/setpoint_line.hpp"
#include "gateway/simulators/vdrive/axis/shaft.hpp"
#include "gateway/simulators/vdrive/axis/target_watch.hpp"
#include "gateway/simulators/vdrive/axis/touch_probes.hpp"
#include "gateway/simulators/vdrive/objects/dictionary.hpp"

namespace rmac::vdrive {

/// Modes of operation (6060h) that this drive does; its 6502h says the same.
enum class Mode : std::int8_t {
  None = 0,
  ProfilePosition = 1,
  ProfileVelocity = 3,
  ProfileTorque = 4,
  Homing = 6,
  InterpolatedPosition = 7,
  CyclicSyncPosition = 8,
  CyclicSyncVelocity = 9,
  CyclicSyncTorque = 10
};

/// The drive behind the dictionary: CiA 402's power states and modes, the drive's own position and velocity loops, and
/// motor, screw and table as the simulated bus has them. Positions are counts of the encoder, velocities counts/s,
/// accelerations counts/s², torques thousandths of the rated one.
class Axis {
 public:
  using Report = std::function<void(std::uint16_t code)>;

  /// `report` hears error codes (603Fh) as they come up, and 0 when a fault was reset.
  Axis(Dictionary& dictionary, const fieldbus::AxisPlantParameters& plant, Report report);

  /// As after power on. The shaft stays where it is.
  void reset();
  /// Acts on an object that was written.
  void take(ObjectAddress object);
  void advance(double duration_s);
  /// Writes what the drive tells into the dictionary.
  void publish();

  void abort_connection();
  void trip(std::uint16_t error_code);
  void shift_encoder(std::int32_t counts) noexcept { shaft_.shift_encoder(counts); }
  void set_overheated(bool overheated) noexcept { overheated_ = overheated; }
  /// The contact at touch probe 1 closes, or opens.
  void touch(bool closed) noexcept { probes_.touch(0, closed); }

  [[nodiscard]] PowerStates::State state() const { return power_.state(); }
  [[nodiscard]] double position() const { return shaft_.position(); }  ///< as homing and faults have shifted it
  [[nodiscard]] double shaft() const { return shaft_.angle(); }  ///< where it really is, from where it was at power on
  [[nodiscard]] double velocity() const { return shaft_.velocity(); }

 private:
  void take_controlword();
  void take_setpoint(ObjectAddress object);
  void take_mode();
  void step(double dt);
  void operate(double dt);
  void push(double torque, double dt);
  void profile_velocity(double dt);
  void profile_position(double dt);
  void interpolate(double dt);
  void home(double dt);
  void ramp_to_rest(Braking by, double slow_down, double dt);
  void stop_at_limits(const Demand& before, double dt);
  /// The demand, and what makes it, are where the shaft is.
  void follow_actual();
  void watch(double dt);
  [[nodiscard]] unsigned mode_bits() const;
  [[nodiscard]] bool standing() const { return demand_.velocity == 0 && shaft_.stands(); }

  Dictionary& dictionary_;
  AxisUnits units_;
  Report report_;
  AxisParameters parameters_;  ///< as the dictionary has them now
  PowerStates power_;
  Shaft shaft_;
  DriveLoops loops_;
  SetpointLine line_;
  PositionTargets targets_;
  HomeSearch home_search_;
  TouchProbes probes_;
  TargetWatch watch_;
  Demand demand_;
  Mode mode_ = Mode::None;
  double torque_nm_ = 0;   ///< that the loops or the master want
  double offset_nm_ = 0;   ///< of it, from the master (60B2h) beside the loops
  double profile_nm_ = 0;  ///< torque of profile torque
  bool limited_ = false;   ///< a limit switch or a software limit acts
  bool braking_ = false;   ///< in the step before
  bool overheated_ = false;
};

}  // namespace rmac::vdrive
