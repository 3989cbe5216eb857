#include <algorithm>
#include <cmath>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

// A drive stands when it has moved by less than this for so long: 1.5 rpm, and some counts of a coarse encoder.
constexpr double kStillS = 0.02;
constexpr double kStillTurns = 5e-4;
constexpr std::int64_t kStillCounts = 2;
constexpr double kStillRpm = 1;
// A drive that has not come to rest by itself by now does not brake.
constexpr double kQuickStopS = 10;

std::int64_t still_counts(double counts_per_turn) noexcept {
  return std::max<std::int64_t>(kStillCounts, std::llround(kStillTurns * counts_per_turn));
}

}  // namespace

StopCategory ServoLoop::Impl::stop_category(const ServoFault& found) const noexcept {
  switch (found.kind) {
    case ServoFault::Kind::SensorLost:
      return parts.stop_categories.sensor_lost;
    case ServoFault::Kind::ForceLimit:
      return parts.stop_categories.force_limit;
    case ServoFault::Kind::ContactLost:
      return parts.stop_categories.contact_lost;
    case ServoFault::Kind::CyclesLost:
      return parts.stop_categories.cycles_lost;
    case ServoFault::Kind::DriveOffline:
      return can_do_without(found) ? parts.stop_categories.drive_silent : StopCategory::StopThenRemovePower;
    case ServoFault::Kind::TorqueBound:
      return found.part == ServoFault::Part::Spindle ? parts.stop_categories.spindle_overload
                                                     : StopCategory::StopThenRemovePower;
    default:
      return StopCategory::StopThenRemovePower;
  }
}

bool ServoLoop::Impl::can_do_without(const ServoFault& found) const noexcept {
  if (found.part != ServoFault::Part::Actuator) return found.part == ServoFault::Part::Spindle;
  return sense[found.index] != 0 && actuators_of[joint_of[found.index]] == std::uint32_t{1} << found.index;
}

void ServoLoop::Impl::raise(const ServoFault& found) noexcept {
  const bool graver = found.kind == ServoFault::Kind::EmergencyStop && fault.kind != found.kind;
  if (state == ServoState::Faulted && !graver) {
    if (!braking) return;
    // Whatever goes wrong on the way takes the choice away.
    braking = false;
    fault.stop = StopCategory::StopThenRemovePower;
    let_go();
    return;
  }
  braking = false;
  // Joints that are not all held, and a drive that has lost its encoder, cannot be braked by this loop.
  const bool drive_lost = found.kind == ServoFault::Kind::SensorLost && found.part != ServoFault::Part::Joint;
  const bool may_choose = state == ServoState::Engaged && !drive_lost;
  fault = found;
  fault.stop = may_choose ? stop_category(found) : StopCategory::StopThenRemovePower;
  state = ServoState::Faulted;
  power_spent = true;
  follows = false;
  rest.fill({});
  stopping_cycles = 0;
  if (fault.stop == StopCategory::StopKeepPower) {
    if (fault.kind == ServoFault::Kind::DriveOffline && fault.part == ServoFault::Part::Actuator) {
      let_go(joint_of[fault.index]);
    }
    begin_braking();
  } else {
    let_go();
  }
}

bool ServoLoop::Impl::given_up(ServoFault::Part part, std::size_t index) const noexcept {
  return braking && fault.kind == ServoFault::Kind::DriveOffline && fault.part == part && fault.index == index;
}

/// Its drive is out of reach, and stops it by its own watch over the appliance.
void ServoLoop::Impl::let_go(std::size_t joint) noexcept {
  live[joint] = handed[joint] = false;
  set_velocity[joint] = set_acceleration[joint] = 0;
  force_loops[joint].restart();
}

void ServoLoop::Impl::begin_braking() noexcept {
  braking = true;
  brake_s = braked_s = 0;
  brake_from = set_velocity;
  for (std::size_t j = 0; j < axes; ++j) {
    const double deceleration = parts.axes[j].bounds.stop_deceleration;
    if (deceleration > 0) brake_s = std::max(brake_s, std::abs(brake_from[j]) / deceleration);
  }
}

void ServoLoop::Impl::brake() noexcept {
  braked_s = std::min(braked_s + parts.period_s, brake_s);
  const double left = brake_s > 0 ? 1 - braked_s / brake_s : 0;
  for (std::size_t j = 0; j < axes; ++j) {
    set_velocity[j] = brake_from[j] * left;
    set_acceleration[j] = left > 0 ? -brake_from[j] / brake_s : 0;
    hold[j] += set_velocity[j] * parts.period_s;
  }
}

bool ServoLoop::Impl::stands() const noexcept {
  if (braking) return braked_s >= brake_s;
  const auto end = rest.begin() + static_cast<std::ptrdiff_t>(actuators + parts.spindles.size());
  return parts.virtual_mode || std::all_of(rest.begin(), end, [](const Rest& drive) { return drive.reached; });
}

void ServoLoop::Impl::remove_power_at_rest() noexcept {
  if (state != ServoState::Faulted || braking) return;
  const bool too_long = static_cast<double>(++stopping_cycles) * parts.period_s > kQuickStopS;
  const auto look = [&](Rest& drive, std::int64_t at, std::int64_t tolerance) {
    if (std::abs(at - drive.mark) > tolerance || stopping_cycles == 1) {
      drive.mark = at;
      drive.still = 0;
    } else {
      ++drive.still;
    }
    drive.reached = drive.reached || too_long || static_cast<double>(drive.still) * parts.period_s >= kStillS;
  };
  for (std::size_t i = 0; i < actuators; ++i) {
    const double counts_per_turn = parts.actuators[i].scale.counts_per_revolution;
    look(rest[i], counts[i], still_counts(counts_per_turn));
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    if (spindles[i].has_encoder()) {
      const double counts_per_turn = parts.spindles[i].scale.counts_per_revolution;
      look(rest[actuators + i], spindles[i].counts(), still_counts(counts_per_turn));
      continue;
    }
    // A spindle stands at 0 rpm, not at any steady speed.
    const bool stands = std::abs(spindles[i].rpm()) <= kStillRpm;
    look(rest[actuators + i], stands ? 0 : stopping_cycles * 1000, 1);
  }
}

}  // namespace rmac
