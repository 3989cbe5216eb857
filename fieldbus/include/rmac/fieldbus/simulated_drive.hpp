#pragma once

#include <optional>

#include "rmac/fieldbus/drive_state_machine.hpp"
#include "rmac/fieldbus/simulated_plant.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus {

/// A servo drive on the plant of one axis, in the cyclic synchronous mode that it is commanded: a torque goes to the
/// current loop; velocities and positions to loops of its own. Sees its words and nothing else.
class SimulatedServoDrive {
 public:
  explicit SimulatedServoDrive(const AxisPlantParameters& parameters) noexcept;

  /// What the drive reports at the beginning of a cycle.
  [[nodiscard]] DriveFeedback feedback() const noexcept;
  /// Acts on `command` for one cycle.
  void advance(const DriveCommand& command, double period_s) noexcept;

  [[nodiscard]] AxisPlant& plant() noexcept { return plant_; }
  [[nodiscard]] DriveStateMachine& power() noexcept { return power_; }
  /// The encoder's reading stays where it is, whatever the shaft does; and goes on.
  void freeze_encoder(bool frozen) noexcept { encoder_.freeze(frozen, sensed_rad()); }
  /// The current loop gives this torque whatever is asked for, while the drive is operational; and obeys again.
  void run_away(std::optional<double> torque_nm) noexcept { runaway_nm_ = torque_nm; }
  /// Moves the encoder's reading without moving the shaft, as a lost reference does.
  void shift_encoder(std::int32_t counts) noexcept { encoder_.shift(counts); }
  /// An edge of a touch probe input, that came while the load stood at `angle_rad` of the shaft.
  void touch(TouchProbeEdge edge, double angle_rad) noexcept;

 private:
  /// The angle that the encoder looks at.
  [[nodiscard]] double sensed_rad() const noexcept;
  [[nodiscard]] double angle_of(std::int32_t counts) const noexcept;
  void run_loops(const DriveCommand& command, double period_s) noexcept;
  void follow_velocity(double wanted_rad_s, double offset_nm, double most_nm, double step_s) noexcept;
  void brake(double period_s) noexcept;
  void take_touch_probe(std::uint16_t function) noexcept;

  AxisPlantParameters parameters_;
  AxisPlant plant_;
  DriveStateMachine power_;
  SimulatedEncoder encoder_;
  double load_nm_ = 0;  ///< that a quick stop has found to hang on the shaft
  std::optional<double> runaway_nm_;
  std::optional<double> aim_rad_;     ///< where the drive was to be at the end of the last cycle in position mode
  double integral_nm_ = 0;            ///< of its velocity loop
  bool brake_closed_ = false;         ///< in a quick stop of an axis that gives way
  std::uint16_t probe_function_ = 0;  ///< 60B8h
  std::uint16_t probe_status_ = 0;    ///< 60B9h
  std::array<std::int32_t, 4> latched_counts_{};
};

/// A spindle drive in profile velocity mode.
class SimulatedSpindleDrive {
 public:
  explicit SimulatedSpindleDrive(const SpindlePlantParameters& parameters) noexcept : plant_(parameters) {}

  [[nodiscard]] DriveFeedback feedback() const noexcept;
  void advance(const DriveCommand& command, double period_s) noexcept;

  [[nodiscard]] DriveStateMachine& power() noexcept { return power_; }
  [[nodiscard]] const SpindlePlant& plant() const noexcept { return plant_; }
  void load(double nm) noexcept { plant_.load(nm); }

 private:
  SpindlePlant plant_;
  DriveStateMachine power_;
};

}  // namespace rmac::fieldbus
