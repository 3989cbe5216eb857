#pragma once

#include <array>
#include <functional>
#include <memory>

#include "gateway/simulators/vdrive/dictionary.hpp"
#include "gateway/simulators/vdrive/homing.hpp"
#include "gateway/simulators/vdrive/power_states.hpp"
#include "gateway/simulators/vdrive/profile.hpp"
#include "gateway/simulators/vdrive/touch_probe.hpp"
#include "rmac/fieldbus/simulated_plant.hpp"

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

  ~Axis();

  /// As after power on. The shaft stays where it is.
  void reset();
  /// Acts on an object that was written.
  void take(ObjectAddress object);
  void advance(double duration_s);
  /// Writes what the drive tells into the dictionary.
  void publish();

  void abort_connection();
  void trip(std::uint16_t error_code);
  void shift_encoder(std::int32_t counts) noexcept { encoder_shift_ += counts; }
  void set_overheated(bool overheated) noexcept { overheated_ = overheated; }
  /// The contact at touch probe 1 or 2 closes, or opens.
  void touch(std::size_t probe, bool closed) noexcept;

  [[nodiscard]] PowerStates::State state() const { return power_.state(); }
  [[nodiscard]] double position() const;  ///< in counts, as homing and faults have shifted them
  [[nodiscard]] double shaft() const;     ///< where it really is, from where it stood at power on
  [[nodiscard]] double velocity() const;

 private:
  struct Parameters;
  [[nodiscard]] Parameters parameters() const;
  void take_controlword();
  void step(const Parameters& parameters, double dt);
  void operate(const Parameters& parameters, double dt);
  void brake(const Parameters& parameters, double dt);
  /// How fast it slows down, in counts/s²; `slow_down` is the ramp where no other is asked for.
  [[nodiscard]] double deceleration(Braking by, double slow_down, const Parameters& parameters) const;
  void home(const Parameters& parameters, double dt);
  void position_profile(const Parameters& parameters, double dt);
  void follow_setpoint(double dt);
  void torque_profile(const Parameters& parameters, double dt);
  void interpolate(const Parameters& parameters, double dt);
  void watch_touch_probes(double shaft_before);
  [[nodiscard]] double told(double shaft) const;  ///< the position told where the shaft is there
  void stop_at_limits(const Demand& before, const Parameters& parameters, double dt);
  void follow_actual();
  [[nodiscard]] double loops(const Parameters& parameters, double dt);
  void watch(const Parameters& parameters, double dt);
  [[nodiscard]] unsigned mode_bits() const;
  [[nodiscard]] bool at_negative_limit() const;
  [[nodiscard]] bool at_positive_limit() const;
  [[nodiscard]] bool standing() const;
  [[nodiscard]] double counts_per_radian() const;
  // Units and sense of what the master says and hears (608Fh, 6091h, 6092h, 607Eh).
  [[nodiscard]] double units_per_count() const;
  [[nodiscard]] double position_units() const;  ///< units a count; negative where positions are turned round
  [[nodiscard]] double velocity_units() const;
  [[nodiscard]] double target_position() const;  ///< 607Ah, in counts

  Dictionary& dictionary_;
  fieldbus::AxisPlantParameters mechanics_;
  fieldbus::AxisPlant plant_;
  Report report_;
  std::unique_ptr<Parameters> parameters_;  ///< as the dictionary has them now
  PowerStates power_;
  Homing homing_;
  Demand demand_;
  Mode mode_ = Mode::None;
  double torque_nm_ = 0;      ///< that the loops or the master want
  double integral_nm_ = 0;    ///< of the position loop
  double offset_ = 0;         ///< of the position told from the shaft's: by homing
  double encoder_shift_ = 0;  ///< the same by a fault
  double index_turn_ = 0;     ///< which turn the index pulse was seen last in
  double setpoint_ = 0;       ///< of cyclic synchronous position
  double setpoint_left_s_ = 0;
  double profile_nm_ = 0;  ///< torque of profile torque
  double target_ = 0;      ///< of profile position
  std::optional<double> next_target_;
  double in_window_s_ = 0;
  double following_error_s_ = 0;
  bool acknowledges_ = false;
  bool new_setpoint_before_ = false;
  bool homes_before_ = false;
  bool at_target_ = false;
  bool limited_ = false;  ///< a limit switch or a software limit acts
  bool following_error_ = false;
  bool braking_ = false;  ///< in the step before
  bool overheated_ = false;
  std::array<TouchProbe, 2> probes_;
  std::array<bool, 2> contacts_{};  ///< as somebody closed them
};

}  // namespace rmac::vdrive
