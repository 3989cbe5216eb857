#include "rmac/fieldbus/simulated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus {

void DriveStateMachine::step(std::uint16_t word) noexcept {
  using namespace controlword;
  const bool reset_rose = (word & kFaultReset) != 0 && (previous_ & kFaultReset) == 0;
  previous_ = word;
  if (state_ == State::Fault) {
    if (reset_rose) {
      state_ = State::SwitchOnDisabled;
      error_code_ = 0;
    }
    return;
  }
  if ((word & kEnableVoltage) == 0) {
    state_ = State::SwitchOnDisabled;
    return;
  }
  if ((word & kNoQuickStop) == 0) {
    state_ = state_ == State::OperationEnabled || state_ == State::QuickStopActive ? State::QuickStopActive
                                                                                   : State::SwitchOnDisabled;
    return;
  }
  // What is left is shutdown, switch on, or enable operation; one transition a cycle.
  const bool switch_on = (word & kSwitchOn) != 0;
  const bool enable = switch_on && (word & kEnableOperation) != 0;
  switch (state_) {
    case State::SwitchOnDisabled:
      if (!switch_on) state_ = State::ReadyToSwitchOn;
      break;
    case State::ReadyToSwitchOn:
      if (switch_on) state_ = State::SwitchedOn;
      break;
    case State::SwitchedOn:
    case State::OperationEnabled:
      state_ = enable ? State::OperationEnabled : switch_on ? State::SwitchedOn : State::ReadyToSwitchOn;
      break;
    case State::QuickStopActive:  // left by disabling the voltage only
    case State::Fault:
      break;
  }
}

void DriveStateMachine::trip(std::uint16_t error_code) noexcept {
  state_ = State::Fault;
  error_code_ = error_code;
}

std::uint16_t DriveStateMachine::statusword() const noexcept {
  constexpr std::uint16_t kVoltageEnabled = 1U << 4;
  constexpr std::uint16_t kRemote = 1U << 9;
  constexpr std::uint16_t kCommon = kVoltageEnabled | kRemote;
  switch (state_) {
    case State::SwitchOnDisabled:
      return kCommon | 0x40;
    case State::ReadyToSwitchOn:
      return kCommon | 0x21;
    case State::SwitchedOn:
      return kCommon | 0x23;
    case State::OperationEnabled:
      return kCommon | 0x27;
    case State::QuickStopActive:
      return kCommon | 0x07;
    case State::Fault:
      return kCommon | 0x08;
  }
  return kCommon;
}

SimulatedServoDrive::SimulatedServoDrive(const AxisPlantParameters& parameters) noexcept
    : parameters_(parameters), plant_(parameters) {}

DriveFeedback SimulatedServoDrive::feedback() const noexcept {
  const double counts = std::floor(plant_.angle_rad() * parameters_.counts_per_revolution / (2 * std::numbers::pi));
  const auto wide = static_cast<std::int64_t>(counts) + encoder_offset_;
  return {
      .statusword = power_.statusword(),
      .error_code = power_.error_code(),
      .position_counts = static_cast<std::int32_t>(static_cast<std::uint64_t>(wide)),
      .velocity_rpm = static_cast<std::int32_t>(std::lround(plant_.speed_rad_s() * 30 / std::numbers::pi)),
      .torque_permille = static_cast<std::int16_t>(std::lround(plant_.motor_nm() * 1000 / parameters_.rated_torque_nm)),
      .online = true};
}

void SimulatedServoDrive::advance(const DriveCommand& command, double period_s) noexcept {
  power_.step(command.controlword);
  const double max_speed_rad_s = parameters_.max_speed_rpm * std::numbers::pi / 30;
  double torque = 0;
  if (power_.operational() && command.mode == DriveMode::CyclicSyncTorque) {
    torque = command.target_torque_permille * parameters_.rated_torque_nm / 1000;
    // The drive takes torque back where it would drive the motor past its speed limit.
    if (std::abs(plant_.speed_rad_s()) >= max_speed_rad_s && torque * plant_.speed_rad_s() > 0) torque = 0;
  }
  const bool braking = power_.quick_stopping();
  if (braking) {
    // Rated torque against the motion, less where that would turn it round within the cycle; the brake closes at rest.
    const double to_rest = plant_.speed_rad_s() * parameters_.inertia_kg_m2() / period_s;
    torque = std::clamp(-to_rest, -parameters_.rated_torque_nm, parameters_.rated_torque_nm);
  }
  constexpr double kStandingRadS = 0.5;
  const bool standing = std::abs(plant_.speed_rad_s()) < kStandingRadS;
  plant_.advance(torque, braking ? standing : !power_.operational(), period_s);
}

DriveFeedback SimulatedSpindleDrive::feedback() const noexcept {
  return {.statusword = power_.statusword(),
          .error_code = power_.error_code(),
          .velocity_rpm = static_cast<std::int32_t>(std::lround(plant_.speed_rpm())),
          .online = true};
}

void SimulatedSpindleDrive::advance(const DriveCommand& command, double period_s) noexcept {
  power_.step(command.controlword);
  const bool runs = power_.operational() && command.mode == DriveMode::ProfileVelocity;
  plant_.advance(runs ? command.target_velocity_rpm : 0, runs || power_.quick_stopping(), period_s);
}

}  // namespace rmac::fieldbus
