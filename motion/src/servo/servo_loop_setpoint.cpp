// Where each joint is to be in a cycle: on the plan, where its force sends it, or where the plan's velocity takes it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

/// Share of the following-error bound that a joint under velocity control may be behind its setpoint.
constexpr double kMostBehind = 0.5;

/// The largest speed from which `way` is enough to come to rest after one more cycle: v T + v² / 2a = way.
double speed_before_end(double way, double deceleration, double period_s) noexcept {
  if (way <= 0 || std::isinf(way)) return std::max(way, 0.0);
  const double braking = deceleration > 0 ? 2 * way / deceleration : 0;
  return 2 * way / (period_s + std::sqrt(period_s * period_s + braking));
}

}  // namespace

void ServoLoop::Impl::make_setpoints(const ServoCommand& command, ServoReport& report) noexcept {
  const auto before = hold;
  const auto velocity_before = set_velocity;
  choose_setpoints(command, report);
  for (std::size_t j = 0; j < axes; ++j) {
    if ((late_joints >> j & 1U) == 0) continue;
    gone_on[j] = hold[j] - before[j];
    velocity_gone_on[j] = set_velocity[j] - velocity_before[j];
  }
}

void ServoLoop::Impl::choose_setpoints(const ServoCommand& command, ServoReport& report) noexcept {
  if (parts.virtual_mode) follows = state == ServoState::Engaged;
  report.follows = follows;
  const auto followed_before = std::exchange(on_the_way, {});
  if (braking) {
    brake();
    return;
  }
  for (std::size_t j = 0; j < axes; ++j) {
    if (parts.axes[j].method == ControlMethod::Force && live[j]) {
      follow_force(j, follows ? command.force[j] : 0);
    } else if (follows && j < joints) {
      const Setpoint& wanted = command.setpoint;
      if (!std::isfinite(wanted.position[j]) || !std::isfinite(wanted.velocity[j]) ||
          !std::isfinite(wanted.acceleration[j])) {
        raise({ServoFault::Kind::NotANumber, ServoFault::Part::Joint, static_cast<std::uint32_t>(j), wanted.position[j],
               0});
        report.follows = false;
        return;
      }
      on_the_way[j] = true;
      if (parts.axes[j].method == ControlMethod::Velocity && live[j]) {
        if (!followed_before[j]) slip[j] = hold[j] - wanted.position[j];
        follow_velocity(j, wanted);
        continue;
      }
      slip[j] = 0;
      hold[j] = wanted.position[j];
      set_velocity[j] = wanted.velocity[j];
      set_acceleration[j] = wanted.acceleration[j];
    } else {
      if (!live[j] && !parts.virtual_mode) hold[j] = position[j];
      set_velocity[j] = set_acceleration[j] = 0;
    }
  }
}

// A joint under force control is out of the plan: its setpoint goes where its force sends it.
void ServoLoop::Impl::follow_force(std::size_t joint, double wanted) noexcept {
  set_velocity[joint] = force_loops[joint].step(std::isfinite(wanted) ? wanted : 0, force[joint]);
  set_acceleration[joint] = 0;
  hold[joint] += set_velocity[joint] * parts.period_s;
}

// A joint under velocity control goes as fast as the plan says. What keeps it from that it does not make good: its
// setpoint goes no further ahead than it may be behind, and turns back from there at once. As long as nothing keeps it,
// it is where the plan has it.
void ServoLoop::Impl::follow_velocity(std::size_t joint, const Setpoint& wanted) noexcept {
  const ServoAxis& axis = parts.axes[joint];
  const double behind = kMostBehind * axis.max_following_error;
  const double from = std::clamp(hold[joint], position[joint] - behind, position[joint] + behind);
  const auto fastest = [&](double way) { return speed_before_end(way, axis.bounds.stop_deceleration, parts.period_s); };
  set_velocity[joint] = std::clamp(wanted.velocity[joint], -fastest(from - axis.bounds.min_position),
                                   fastest(axis.bounds.max_position - from));
  if (from == hold[joint] && set_velocity[joint] == wanted.velocity[joint]) {
    set_acceleration[joint] = wanted.acceleration[joint];
    hold[joint] = wanted.position[joint] + slip[joint];
  } else {
    set_acceleration[joint] = set_velocity[joint] == wanted.velocity[joint] ? wanted.acceleration[joint] : 0;
    hold[joint] = from + set_velocity[joint] * parts.period_s;
    slip[joint] = hold[joint] - wanted.position[joint];
  }
}

double ServoLoop::slipped(std::size_t joint) const noexcept {
  return impl_->slip[joint];
}

void ServoLoop::set_control_method(std::size_t joint, ControlMethod method) noexcept {
  impl_->parts.axes[joint].method = method;
}

void ServoLoop::Impl::reflect_setpoints() noexcept {
  position = hold;
  velocity = set_velocity;
}

}  // namespace rmac
