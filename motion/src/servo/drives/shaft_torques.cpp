#include "servo/drives/shaft_torques.hpp"

#include <cmath>

#include "rmac/motion/drive_scale.hpp"

namespace rmac {

ShaftTorques::ShaftTorques(const ActuatorMap& map, std::span<const ServoActuator> actuators, double period_s)
    : map_(map), actuators_(actuators), period_s_(period_s) {
  for (const ServoActuator& actuator : actuators) {
    if (!cogging_.emplace_back(actuator.cogging).empty()) have_cogging_ |= only(cogging_.size() - 1);
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

void ShaftTorques::add(std::span<const double> more_nm, IndexSet followed) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (has(followed, i)) torque_[i] += more_nm[i];
  }
}

void ShaftTorques::cancel_cogging(std::span<const double> measured, std::span<const double> wanted,
                                  IndexSet followed) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (!has(have_cogging_ & followed, i) || !std::isfinite(wanted[i])) continue;
    const double way = has(followed_, i) ? wanted[i] - wanted_before_[i] : 0;
    const DriveScale& scale = actuators_[i].scale;
    const double acts_at = measured[i] + way * actuators_[i].cogging.lead_s / period_s_;
    torque_[i] -= scale.direction * cogging_[i].torque_nm(shaft_counts(scale, acts_at) / scale.counts_per_revolution);
    wanted_before_[i] = wanted[i];
  }
  followed_ = followed;
}

}  // namespace rmac
