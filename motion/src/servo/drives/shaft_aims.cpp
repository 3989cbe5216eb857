#include "servo/drives/shaft_aims.hpp"

#include <cmath>
#include <numbers>

#include "rmac/motion/drive_scale.hpp"

namespace rmac {

ShaftAims::ShaftAims(std::span<const ServoActuator> actuators, const Wiring::Delays& delays, double period_s) noexcept
    : actuators_(actuators), period_s_(period_s) {
  for (std::size_t i = 0; i < actuators_.size(); ++i) ways_[i] = RecentWay(delays[i]);
}

void ShaftAims::step(std::span<const double> wanted, IndexSet followed, FaultSink& faults) noexcept {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (has(followed, i) && !std::isfinite(wanted[i])) {
      faults.raise(
          {ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, static_cast<std::uint32_t>(i), wanted[i], 0});
      aimed_ = 0;
      return;
    }
    aim_before_[i] = has(aimed_, i) ? aim_[i] : wanted[i];
    aim_[i] = wanted[i];
    if (!has(aimed_, i)) ways_[i].forget();
    ways_[i].begin_cycle();
    ways_[i].went(aim_[i] - aim_before_[i]);
  }
  aimed_ = followed;
}

void ShaftAims::command(std::size_t actuator, double measured_rad, DriveCommand& words) const noexcept {
  const ServoActuator& part = actuators_[actuator];
  const double aim = aim_[actuator], before = aim_before_[actuator];
  const double to_rpm = part.scale.direction * 30 / std::numbers::pi;
  const double aim_rad_s = (aim - before) / period_s_;
  if (part.mode == DriveMode::CyclicSyncPosition) {
    words.target_position_counts = position_word(shaft_counts(part.scale, aim));
    words.velocity_offset_rpm = to_rpm * aim_rad_s;
    return;
  }
  const double when_it_told = aim - ways_[actuator].length();
  words.target_velocity_rpm = to_rpm * (aim_rad_s + part.position_gain * (when_it_told - measured_rad));
}

}  // namespace rmac
