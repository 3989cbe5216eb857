#pragma once

#include "rmac/fieldbus/simulated_plant.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus {

/// The power state machine inside a CiA 402 drive: controlwords in, statusword out. Real-time safe.
class DriveStateMachine {
 public:
  /// Takes one controlword: one transition at most.
  void step(std::uint16_t controlword) noexcept;
  /// Goes to Fault and stays there until a fault reset finds the cause gone.
  void trip(std::uint16_t error_code) noexcept;

  [[nodiscard]] std::uint16_t statusword() const noexcept;
  [[nodiscard]] std::uint16_t error_code() const noexcept { return error_code_; }
  [[nodiscard]] bool operational() const noexcept { return state_ == State::OperationEnabled; }
  [[nodiscard]] bool quick_stopping() const noexcept { return state_ == State::QuickStopActive; }

 private:
  enum class State : std::uint8_t {
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStopActive,
    Fault
  };
  State state_ = State::SwitchOnDisabled;
  std::uint16_t previous_ = 0;
  std::uint16_t error_code_ = 0;
};

/// A servo drive in cyclic synchronous torque mode on the plant of one axis. Sees its words and nothing else.
class SimulatedServoDrive {
 public:
  explicit SimulatedServoDrive(const AxisPlantParameters& parameters) noexcept;

  /// What the drive reports at the beginning of a cycle.
  [[nodiscard]] DriveFeedback feedback() const noexcept;
  /// Acts on `command` for one cycle.
  void advance(const DriveCommand& command, double period_s) noexcept;

  [[nodiscard]] AxisPlant& plant() noexcept { return plant_; }
  [[nodiscard]] DriveStateMachine& power() noexcept { return power_; }
  /// Moves the encoder's reading without moving the shaft, as a lost reference does.
  void shift_encoder(std::int32_t counts) noexcept { encoder_offset_ += counts; }

 private:
  AxisPlantParameters parameters_;
  AxisPlant plant_;
  DriveStateMachine power_;
  std::int64_t encoder_offset_ = 0;
};

/// A spindle drive in profile velocity mode.
class SimulatedSpindleDrive {
 public:
  explicit SimulatedSpindleDrive(const SpindlePlantParameters& parameters) noexcept : plant_(parameters) {}

  [[nodiscard]] DriveFeedback feedback() const noexcept;
  void advance(const DriveCommand& command, double period_s) noexcept;

  [[nodiscard]] DriveStateMachine& power() noexcept { return power_; }
  [[nodiscard]] const SpindlePlant& plant() const noexcept { return plant_; }

 private:
  SpindlePlant plant_;
  DriveStateMachine power_;
};

}  // namespace rmac::fieldbus
