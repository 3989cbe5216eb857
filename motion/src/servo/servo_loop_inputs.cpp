#include <bit>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

void ServoLoop::Impl::read_drive_inputs(std::uint64_t& now) const noexcept {
  for (const ServoDriveInput& input : parts.drive_inputs) {
    now &= ~input.input;
    if ((feedback(input.actuator).inputs & input.drive_bit) != 0) now |= input.input;
  }
}

void ServoLoop::Impl::read_probe() noexcept {
  bool latched = false;
  for (std::size_t i = 0; i < actuators; ++i) {
    if (latches[i] && latches[i]->read(feedback(i), probe.report().touching)) latched = true;
  }
  const auto bit = static_cast<std::size_t>(std::countr_zero(parts.probe.touch_input));
  const double on_for_s = parts.io && parts.probe.touch_input != 0 ? parts.io->on_for_s(bit) : 0;
  probe.read(parts.probe, inputs, on_for_s, latched, parts.period_s);
}

/// The probe's report with what the drives have latched, as positions of joints.
ProbeReport ServoLoop::Impl::probe_report() const noexcept {
  ProbeReport report = probe.report();
  std::uint32_t armed = 0, latched = 0;
  std::array<double, kMaxJoints> at = shaft;
  for (std::size_t i = 0; i < actuators; ++i) {
    if (!latches[i] || !latches[i]->armed()) continue;
    armed |= std::uint32_t{1} << i;
    if (!latches[i]->latched() || !seen[i]) continue;
    latched |= std::uint32_t{1} << i;
    // The drive's word wraps, and the place of the hit is near.
    const auto back = static_cast<std::int32_t>(static_cast<std::uint32_t>(latches[i]->counts()) -
                                                static_cast<std::uint32_t>(counts[i]));
    at[i] = shaft_rad(i, static_cast<double>(counts[i] + back));
  }
  if (armed == 0) return report;
  for (std::size_t j = 0; j < axes; ++j) {
    const std::uint32_t needed = actuators_of[j];
    if (needed != 0 && (needed & ~armed) == 0) report.latching |= std::uint32_t{1} << j;
    if (needed != 0 && (needed & ~latched) == 0) report.latched |= std::uint32_t{1} << j;
  }
  if (report.latched != 0) joints_for({at.data(), actuators}, {report.latched_position.data(), axes});
  return report;
}

}  // namespace rmac
