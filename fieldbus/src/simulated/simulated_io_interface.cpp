#include "rmac/fieldbus/simulated_io_interface.hpp"

#include <cmath>

namespace rmac::fieldbus {

SimulatedIoInterface::SimulatedIoInterface(const std::vector<SimulatedValve>& valves, double period_s) {
  for (const SimulatedValve& valve : valves) {
    valves_.push_back({std::uint64_t{1} << valve.output, std::uint64_t{1} << valve.input, valve.inverted,
                       std::llround(valve.delay_s / period_s), valve.inverted, 0});
  }
}

bool SimulatedIoInterface::exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept {
  if (failed_) {
    outputs_ = 0;
    return false;
  }
  outputs_ = outputs;
  inputs = inputs_;
  for (Valve& valve : valves_) {
    const bool wanted = ((outputs & valve.output) != 0) != valve.inverted;
    valve.differs_for = wanted == valve.on ? 0 : valve.differs_for + 1;
    if (valve.differs_for > valve.delay_cycles) valve.on = wanted;
    if (valve.on) inputs |= valve.input;
  }
  return true;
}

}  // namespace rmac::fieldbus
