#include "servo/watch/input_watch.hpp"

#include <bit>

namespace rmac {

namespace {

/// mm/s or deg/s; less is rounding.
constexpr double kStanding = 1e-6;

void raise_inputs(ServoFault::Kind kind, std::uint64_t inputs, FaultSink& faults) noexcept {
  faults.raise({kind, ServoFault::Part::Io, static_cast<std::uint32_t>(std::countr_zero(inputs)), 0, 0});
}

}  // namespace

void InputWatch::step(std::uint64_t inputs, IndexSet homing, FaultSink& faults) noexcept {
  const std::uint64_t pressed = inputs & parts_.emergency_stop_inputs;
  std::uint64_t reached = inputs & ~inputs_ & parts_.limit_inputs;
  inputs_ = inputs;
  for (const ServoLimit& limit : parts_.limits) {
    if (has(homing, limit.joint)) reached &= ~limit.input;
  }
  if (pressed != 0) raise_inputs(ServoFault::Kind::EmergencyStop, pressed, faults);
  if (reached != 0) raise_inputs(ServoFault::Kind::LimitSwitch, reached, faults);
}

void InputWatch::hold_back(IndexSet live, std::span<const double> velocity_set, FaultSink& faults) const noexcept {
  for (const ServoLimit& limit : parts_.limits) {
    const bool on = (inputs_ & limit.input) != 0;
    if (!on || !has(live, limit.joint) || velocity_set[limit.joint] * limit.direction <= kStanding) continue;
    raise_inputs(ServoFault::Kind::LimitSwitch, limit.input, faults);
    return;
  }
}

}  // namespace rmac
