#include "servo/drives/shaft_torques.hpp"

#include <cmath>
#include <numbers>

#include "rmac/motion/drive_scale.hpp"

namespace rmac {

namespace {

/// At the shaft, in its sense.
double cogging_nm(const ServoActuator& actuator, double shaft_rad) noexcept {
  const DriveScale& scale = actuator.scale;
  const double turn = shaft_counts(scale, shaft_rad) / scale.counts_per_revolution;
  const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
  double torque = 0;
  for (const Cogging::Harmonic& one : actuator.cogging.harmonics) {
    torque += one.cosine_nm * std::cos(one.order * angle) + one.sine_nm * std::sin(one.order * angle);
  }
  return scale.direction * torque;
}

}  // namespace

ShaftTorques::ShaftTorques(const ActuatorMap& map, std::span<const ServoActuator> actuators, double period_s) noexcept
    : map_(map), actuators_(actuators), period_s_(period_s) {
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (!actuators[i].cogging.harmonics.empty()) cogging_ |= only(i);
  }
}

void ShaftTorques::make(std::span<const double> joints, std::span<const double> efforts, FaultSink& faults) noexcept {
  map_.actuator_efforts(joints, efforts, {torque_.data(), actuators_.size()});
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (std::isfinite(torque_[i])) continue;
    faults.raise(
        {ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), torque_[i], 0});
    let_go();
    return;
  }
}

void ShaftTorques::cancel_cogging(std::span<const double> measured, std::span<const double> wanted,
                                  IndexSet followed) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (!has(cogging_ & followed, i) || !std::isfinite(wanted[i])) continue;
    const double way = has(followed_, i) ? wanted[i] - wanted_before_[i] : 0;
    torque_[i] -= cogging_nm(actuators_[i], measured[i] + way * actuators_[i].cogging.lead_s / period_s_);
    wanted_before_[i] = wanted[i];
  }
  followed_ = followed;
}

}  // namespace rmac
