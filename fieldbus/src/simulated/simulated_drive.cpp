#include "rmac/fieldbus/simulated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::fieldbus {

namespace {

// Assumed, as servo drives of this size are tuned: loops at 8 kHz, 95 Hz of velocity and 24 Hz of position.
constexpr double kLoopS = 125e-6, kVelocityRadS = 600, kIntegralRadS = 150, kPositionRadS = 150;
constexpr double kStandingRadS = 0.5;

}  // namespace

SimulatedServoDrive::SimulatedServoDrive(const AxisPlantParameters& parameters) noexcept
    : parameters_(parameters), plant_(parameters), encoder_(parameters.encoder) {}

double SimulatedServoDrive::sensed_rad() const noexcept {
  return parameters_.encoder.at_load ? plant_.load_rad() : plant_.angle_rad();
}

DriveFeedback SimulatedServoDrive::feedback() const noexcept {
  const double load = plant_.load_rad();
  return {
      .statusword = power_.statusword(),
      .error_code = power_.error_code(),
      .position_counts = encoder_.counts(sensed_rad()),
      .load_counts = encoder_.counts_without_error(load),
      .velocity_rpm = static_cast<std::int32_t>(std::lround(plant_.speed_rad_s() * 30 / std::numbers::pi)),
      .torque_permille = static_cast<std::int16_t>(std::lround(plant_.motor_nm() * 1000 / parameters_.rated_torque_nm)),
      .online = true,
      .inputs =
          (load <= parameters_.negative_switch_rad ? 1U : 0U) | (load >= parameters_.positive_switch_rad ? 2U : 0U),
      .touch_probe = probe_status_,
      .latched_counts = latched_counts_};
}

/// What is no longer wanted is no longer kept (CiA 402-2, touch probe: a new edge is waited for after 0 and 1 again).
void SimulatedServoDrive::take_touch_probe(std::uint16_t function) noexcept {
  probe_function_ = function;
  for (const unsigned probe : {0U, 8U}) {
    const unsigned wanted = static_cast<unsigned>(function) >> probe;
    unsigned keeps = (wanted & 0x10U) != 0 ? 0x02U : 0U;
    if ((wanted & 0x20U) != 0) keeps |= 0x04U;
    const unsigned enabled = wanted & 1U;
    const unsigned status = enabled != 0 ? enabled | (static_cast<unsigned>(probe_status_) >> probe & keeps) : 0U;
    probe_status_ = static_cast<std::uint16_t>((probe_status_ & ~(0xFFU << probe)) | status << probe);
  }
}

void SimulatedServoDrive::touch(TouchProbeEdge edge, double angle_rad) noexcept {
  const unsigned wanted = static_cast<unsigned>(probe_function_) >> touch_probe::shift_of(edge);
  const bool waits = (wanted & 1U) != 0 && (wanted & (touch_probe::falls(edge) ? 0x20U : 0x10U)) != 0;
  const bool again = (wanted & 2U) != 0;
  if (!waits || (!again && (probe_status_ & touch_probe::latched(edge)) != 0)) return;
  latched_counts_[static_cast<std::size_t>(edge)] = encoder_.counts(angle_rad + (sensed_rad() - plant_.load_rad()));
  probe_status_ = static_cast<std::uint16_t>(probe_status_ | touch_probe::latched(edge));
}

/// The angle where the encoder reads this: among all such angles, the one within half of its range.
double SimulatedServoDrive::angle_of(std::int32_t counts) const noexcept {
  const auto way = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts) -
                                             static_cast<std::uint32_t>(encoder_.counts(sensed_rad())));
  const double per_count = 2 * std::numbers::pi / parameters_.encoder.counts_per_revolution;
  return (std::floor(sensed_rad() / per_count) + way) * per_count;
}

void SimulatedServoDrive::follow_velocity(double wanted_rad_s, double offset_nm, double most_nm,
                                          double step_s) noexcept {
  const double max_speed_rad_s = parameters_.max_speed_rpm * std::numbers::pi / 30;
  const double excess = std::clamp(wanted_rad_s, -max_speed_rad_s, max_speed_rad_s) - plant_.speed_rad_s();
  const double gain = kVelocityRadS * parameters_.inertia_kg_m2();
  integral_nm_ = std::clamp(integral_nm_ + gain * kIntegralRadS * excess * step_s, -most_nm, most_nm);
  plant_.advance(std::clamp(gain * excess + integral_nm_ + offset_nm, -most_nm, most_nm), false, step_s);
}

void SimulatedServoDrive::run_loops(const DriveCommand& command, double period_s) noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(period_s / kLoopS - 1e-9)));
  const double step_s = period_s / steps;
  const bool to_position = command.mode == DriveMode::CyclicSyncPosition;
  const double aim = to_position ? angle_of(command.target_position_counts) : 0;
  const double offset_nm = command.torque_offset_permille * parameters_.rated_torque_nm / 1000;
  const double from = to_position ? aim_rad_.value_or(aim) : 0;
  const double beside = parameters_.own_velocity * (aim - from) / period_s +
                        parameters_.told_velocity * command.velocity_offset_rpm * std::numbers::pi / 30;
  for (int i = 1; i <= steps; ++i) {
    double wanted = command.target_velocity_rpm * std::numbers::pi / 30;
    // Between two positions it interpolates (60C2h).
    if (to_position) wanted = beside + kPositionRadS * (from + (aim - from) * i / steps - sensed_rad());
    follow_velocity(wanted, offset_nm, parameters_.peak_torque_nm, step_s);
  }
  if (to_position) aim_rad_ = aim;
}

/// An axis that gives way is braked by the velocity loop, which is quick enough for it; at rest the brake closes.
void SimulatedServoDrive::brake(double period_s) noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(period_s / kLoopS - 1e-9)));
  const double step_s = period_s / steps;
  brake_closed_ = brake_closed_ || std::abs(plant_.speed_rad_s()) < kStandingRadS;
  if (brake_closed_) {
    constexpr double kFadesS = 0.02;  // assumed: what the brake holds the motor need not
    integral_nm_ *= std::exp(-period_s / kFadesS);
    plant_.advance(integral_nm_, true, period_s);
    return;
  }
  for (int i = 0; i < steps; ++i) follow_velocity(0, 0, parameters_.rated_torque_nm, step_s);
}

void SimulatedServoDrive::advance(const DriveCommand& command, double period_s) noexcept {
  encoder_.sample();
  power_.step(command.controlword);
  take_touch_probe(command.touch_probe);
  const bool has_loop = command.mode == DriveMode::CyclicSyncPosition || command.mode == DriveMode::CyclicSyncVelocity;
  if (has_loop && power_.operational() && !runaway_nm_) {
    run_loops(command, period_s);
    return;
  }
  aim_rad_.reset();
  if (parameters_.gives_way() && power_.quick_stopping()) {
    brake(period_s);
    return;
  }
  brake_closed_ = false;
  integral_nm_ = 0;
  const double max_speed_rad_s = parameters_.max_speed_rpm * std::numbers::pi / 30;
  double torque = 0;
  if (power_.operational() && command.mode == DriveMode::CyclicSyncTorque) {
    torque = command.target_torque_permille * parameters_.rated_torque_nm / 1000;
    // The drive takes torque back where it would drive the motor past its speed limit.
    if (std::abs(plant_.speed_rad_s()) >= max_speed_rad_s && torque * plant_.speed_rad_s() > 0) torque = 0;
  }
  if (runaway_nm_ && power_.operational()) torque = *runaway_nm_;
  const bool braking = power_.quick_stopping();
  if (braking) {
    // Rated torque against the motion, less where that would turn it round within the cycle, and an integral part that
    // takes up a hanging load; the brake closes at rest.
    constexpr double kIntegralShare = 0.05;
    const double to_rest = plant_.speed_rad_s() * parameters_.inertia_kg_m2() / period_s;
    torque = std::clamp(load_nm_ - to_rest, -parameters_.rated_torque_nm, parameters_.rated_torque_nm);
    load_nm_ =
        std::clamp(load_nm_ - kIntegralShare * to_rest, -parameters_.rated_torque_nm, parameters_.rated_torque_nm);
  } else {
    load_nm_ = 0;
  }
  const bool standing = std::abs(plant_.speed_rad_s()) < kStandingRadS;
  plant_.advance(torque, braking ? standing : !power_.operational(), period_s);
}

DriveFeedback SimulatedSpindleDrive::feedback() const noexcept {
  return {.statusword = power_.statusword(),
          .error_code = power_.error_code(),
          .velocity_rpm = static_cast<std::int32_t>(std::lround(plant_.speed_rpm())),
          .torque_permille = static_cast<std::int16_t>(std::lround(plant_.torque_permille())),
          .online = true};
}

void SimulatedSpindleDrive::advance(const DriveCommand& command, double period_s) noexcept {
  power_.step(command.controlword);
  const bool runs = power_.operational() && command.mode == DriveMode::ProfileVelocity;
  plant_.advance(runs ? command.target_velocity_rpm : 0, runs || power_.quick_stopping(), period_s);
}

}  // namespace rmac::fieldbus
