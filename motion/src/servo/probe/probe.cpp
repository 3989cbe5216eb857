#include "servo/probe/probe.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace rmac {

Probe::Probe(const ServoLoopParts& parts, const Wiring& wiring) : parts_(parts), wiring_(wiring) {
  for (const ServoActuator& actuator : parts.actuators) {
    latches_.push_back(actuator.probe_edge ? std::optional(ProbeLatch(*actuator.probe_edge)) : std::nullopt);
  }
}

void Probe::read(std::uint64_t inputs) noexcept {
  bool latched = false;
  for (std::size_t i = 0; i < latches_.size(); ++i) {
    const ServoActuator& actuator = parts_.actuators[i];
    const DriveFeedback& words = actuator.bus->feedback[actuator.axis];
    if (latches_[i] && latches_[i]->read(words, signal_.report().touching)) latched = true;
  }
  const auto bit = static_cast<std::size_t>(std::countr_zero(parts_.probe.touch_input));
  const double on_for_s = parts_.io && parts_.probe.touch_input != 0 ? parts_.io->on_for_s(bit) : 0;
  signal_.read(parts_.probe, inputs, on_for_s, latched, parts_.period_s);
}

std::uint16_t Probe::function(std::size_t actuator) const noexcept {
  return latches_[actuator] ? latches_[actuator]->function() : std::uint16_t{0};
}

ProbeReport Probe::report(const Shafts& shafts, const Transmission& transmission) const noexcept {
  ProbeReport report = signal_.report();
  IndexSet armed = 0, latched = 0;
  for (std::size_t i = 0; i < latches_.size(); ++i) {
    if (latches_[i] && latches_[i]->armed()) armed |= only(i);
  }
  if (armed == 0) return report;
  std::array<double, kMaxJoints> at{};
  std::copy(shafts.rad().begin(), shafts.rad().end(), at.begin());
  for (std::size_t i = 0; i < latches_.size(); ++i) {
    if (!has(armed, i) || !latches_[i]->latched() || !shafts[i].seen()) continue;
    latched |= only(i);
    // The place of the hit is near.
    const std::int64_t counts = shafts[i].counts() + counts_gone(shafts[i].counts(), latches_[i]->counts());
    at[i] = shaft_rad(parts_.actuators[i].scale, static_cast<double>(counts));
  }
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    const IndexSet needed = wiring_.actuators_of(j);
    if (needed != 0 && (needed & ~armed) == 0) report.latching |= only(j);
    if (needed != 0 && (needed & ~latched) == 0) report.latched |= only(j);
  }
  if (report.latched != 0) {
    transmission.joints_for({at.data(), latches_.size()}, {report.latched_position.data(), wiring_.joints()});
  }
  return report;
}

}  // namespace rmac
