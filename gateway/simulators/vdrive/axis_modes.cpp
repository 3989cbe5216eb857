#include <algorithm>
#include <cmath>

#include "gateway/simulators/vdrive/axis_parameters.hpp"

namespace rmac::vdrive {
namespace {

// Bandwidths of the loops, well apart from each other and from the current loop's 5000 rad/s.
constexpr double kVelocityBandwidth = 700;  // 1/s
constexpr double kPositionBandwidth = 150;  // 1/s
constexpr double kIntegral = 50;            // 1/s

}  // namespace

void Axis::operate(const Parameters& parameters, double dt) {
  const bool halt = parameters.halts();
  switch (mode_) {
    case Mode::ProfileTorque:
      torque_profile(parameters, dt);
      [[fallthrough]];
    case Mode::CyclicSyncTorque: {
      const double torque = mode_ == Mode::ProfileTorque ? profile_nm_ : parameters.target_torque;
      follow_actual();
      torque_nm_ = torque;
      const double top = mechanics_.max_speed_rpm / 60 * mechanics_.counts_per_revolution;
      const bool too_fast = std::abs(velocity()) >= top && torque * velocity() > 0;
      limited_ = (torque > 0 && at_positive_limit()) || (torque < 0 && at_negative_limit());
      // Into a limit switch it brakes instead, as far as that does not turn it round within the step.
      const double to_rest = -plant_.speed_rad_s() * mechanics_.inertia_kg_m2() / dt;
      if (limited_) torque_nm_ = std::clamp(to_rest, -mechanics_.rated_torque_nm, mechanics_.rated_torque_nm);
      if (too_fast) torque_nm_ = 0;
      break;
    }
    case Mode::CyclicSyncPosition:
      setpoint_ = std::clamp(setpoint_, parameters.least_position, parameters.most_position);
      follow_setpoint(dt);
      break;
    case Mode::InterpolatedPosition:
      interpolate(parameters, dt);
      break;
    case Mode::CyclicSyncVelocity:
      demand_.acceleration = 0;
      demand_.velocity = parameters.target_velocity;
      demand_.position += demand_.velocity * dt;
      break;
    case Mode::ProfileVelocity: {
      const double wanted = halt ? 0 : parameters.target_velocity;
      const bool slows = std::abs(wanted) < std::abs(demand_.velocity) || wanted * demand_.velocity < 0;
      const Braking by = halt ? parameters.halting : Braking::SlowDown;
      demand_.ramp(wanted, slows ? deceleration(by, parameters.deceleration, parameters) : parameters.acceleration, dt);
      break;
    }
    case Mode::ProfilePosition:
      if (halt) {
        demand_.ramp(0, deceleration(parameters.halting, parameters.deceleration, parameters), dt);
      } else {
        position_profile(parameters, dt);
      }
      break;
    case Mode::Homing:
      home(parameters, dt);
      break;
    default:
      follow_actual();
      break;
  }
}

/// Along a straight line to the setpoint, which it reaches when the next one is due.
void Axis::follow_setpoint(double dt) {
  if (setpoint_left_s_ < dt / 2) {
    demand_.position = setpoint_;
    demand_.velocity = demand_.acceleration = 0;
    return;
  }
  demand_.velocity = (setpoint_ - demand_.position) / std::max(setpoint_left_s_, dt);
  demand_.acceleration = 0;
  demand_.position += demand_.velocity * dt;
  setpoint_left_s_ -= dt;
}

/// Towards the target torque (or none, on a halt) by the torque slope (CiA 402-2, profile torque).
void Axis::torque_profile(const Parameters& parameters, double dt) {
  const double wanted = parameters.halts() ? 0 : parameters.target_torque;
  const double step = parameters.torque_slope * dt;
  profile_nm_ += std::clamp(wanted - profile_nm_, -step, step);
}

/// While bit 4 of the controlword is on; else it comes to rest, and stays.
void Axis::interpolate(const Parameters& parameters, double dt) {
  const bool halt = parameters.halts();
  if ((parameters.controlword & 0x10) == 0 || halt) {
    const Braking by = halt ? parameters.halting : Braking::SlowDown;
    demand_.ramp(0, deceleration(by, parameters.deceleration, parameters), dt);
    setpoint_ = demand_.position;
    setpoint_left_s_ = 0;
    return;
  }
  setpoint_ = std::clamp(setpoint_, parameters.least_position, parameters.most_position);
  follow_setpoint(dt);
}

/// The contact closes where the shaft comes into its zone, at the very count, and wherever somebody closes it.
void Axis::watch_touch_probes(double shaft_before) {
  const double now = shaft();
  const double from = parameters_->touches_from, to = parameters_->touches_to;
  const auto inside = [&](double at) { return at >= from && at <= to; };
  const auto in_units = [units = position_units()](double at) {
    return static_cast<std::int32_t>(std::llround(at * units));
  };
  const bool was_in = inside(shaft_before);
  double edge = now;
  if (was_in != inside(now)) edge = was_in == (now > shaft_before) ? to : from;
  probes_[0].see(contacts_[0] || inside(now), in_units(told(edge)));
  probes_[1].see(contacts_[1], in_units(position()));
  const double turn = mechanics_.counts_per_revolution;
  const double pulses = std::floor((now - parameters_->index) / turn);
  if (pulses == std::floor((shaft_before - parameters_->index) / turn)) return;
  const double pulse = parameters_->index + turn * (now > shaft_before ? pulses : pulses + 1);
  for (TouchProbe& probe : probes_) probe.see_index(in_units(told(pulse)));
}

void Axis::touch(std::size_t probe, bool closed) noexcept {
  contacts_.at(probe) = closed;
}

void Axis::position_profile(const Parameters& parameters, double dt) {
  const double target = std::clamp(target_, parameters.least_position, parameters.most_position);
  limited_ = target != target_;
  const bool arrived =
      demand_.approach(target, parameters.velocity, parameters.acceleration, parameters.deceleration, dt);
  if (arrived && next_target_) {
    target_ = *next_target_;
    next_target_.reset();
    at_target_ = false;
    if (!new_setpoint_before_) acknowledges_ = false;
  }
}

void Axis::home(const Parameters& parameters, double dt) {
  const bool start = (parameters.controlword & 0x10) != 0;
  const int method = parameters.homing_method;
  if (start && !homes_before_ && Homing::knows(method)) homing_.start(method);
  if (!start && homing_.state() == Homing::State::Running) homing_.stop();
  homes_before_ = start;
  const double shaft_now = shaft();
  const double turn = std::floor((shaft_now - parameters_->index) / mechanics_.counts_per_revolution);
  const bool in_cam = shaft_now >= parameters_->cam_from && shaft_now <= parameters_->cam_to;
  const int direction = homing_.step({.negative_limit = at_negative_limit(),
                                      .positive_limit = at_positive_limit(),
                                      .home_switch = in_cam,
                                      .index = turn != index_turn_,
                                      .standing = standing()});
  index_turn_ = turn;
  if (parameters.halts()) {
    demand_.ramp(0, deceleration(parameters.halting, parameters.homing_acceleration, parameters), dt);
  } else {
    const double velocity = direction * (homing_.fast() ? parameters.fast : parameters.slow);
    demand_.ramp(velocity, parameters.homing_acceleration, dt);
  }
  if (homing_.found()) {
    // Zero lies at home plus the home offset (607Ch); what the loops follow moves with it.
    const double shift = -parameters_->home_offset - position();
    offset_ += shift;
    demand_.position += shift;
    setpoint_ = target_ = demand_.position;
  }
}

/// Into a closed limit switch no demand goes on: it comes to rest on the quick stop's deceleration and stays.
void Axis::stop_at_limits(const Demand& before, const Parameters& parameters, double dt) {
  const bool into = (demand_.velocity > 0 && at_positive_limit()) || (demand_.velocity < 0 && at_negative_limit());
  if (!into) return;
  limited_ = true;
  demand_ = before;
  demand_.ramp(0, parameters.quick_stop, dt);
}

void Axis::brake(const Parameters& parameters, double dt) {
  demand_.ramp(0, deceleration(power_.braking(), parameters.deceleration, parameters), dt);
  torque_nm_ = loops(parameters, dt);
}

double Axis::deceleration(Braking by, double slow_down, const Parameters& parameters) const {
  const double possible = mechanics_.rated_torque_nm / mechanics_.inertia_kg_m2() * counts_per_radian();
  if (by == Braking::Torque) return possible;
  return std::min(by == Braking::SlowDown ? slow_down : parameters.quick_stop, possible);
}

double Axis::loops(const Parameters& parameters, double dt) {
  const double nm_per_count = mechanics_.inertia_kg_m2() / counts_per_radian();
  const double position_error = demand_.position - position();
  const double velocity_error = demand_.velocity - velocity();
  const double gain = nm_per_count * kVelocityBandwidth * kPositionBandwidth;
  integral_nm_ += gain * kIntegral * position_error * dt;
  integral_nm_ = std::clamp(integral_nm_, -parameters.most_torque, parameters.most_torque);
  return nm_per_count * (demand_.acceleration + kVelocityBandwidth * velocity_error) + gain * position_error +
         integral_nm_;
}

}  // namespace rmac::vdrive
