#include <algorithm>
#include <cmath>

#include "gateway/simulators/vdrive/axis/axis.hpp"

namespace rmac::vdrive {

void Axis::operate(double dt) {
  switch (mode_) {
    case Mode::ProfileTorque: {
      // Towards the target torque (or none, on a halt) by the torque slope (CiA 402-2, profile torque).
      const double wanted = parameters_.halts() ? 0 : parameters_.target_torque;
      const double step = parameters_.torque_slope * dt;
      profile_nm_ += std::clamp(wanted - profile_nm_, -step, step);
      return push(profile_nm_, dt);
    }
    case Mode::CyclicSyncTorque:
      return push(parameters_.target_torque, dt);
    case Mode::CyclicSyncPosition:
      return line_.follow(demand_, parameters_.least_position, parameters_.most_position, dt);
    case Mode::InterpolatedPosition:
      return interpolate(dt);
    case Mode::CyclicSyncVelocity:
      demand_.acceleration = 0;
      demand_.velocity = parameters_.target_velocity;
      demand_.position += demand_.velocity * dt;
      return;
    case Mode::ProfileVelocity:
      return profile_velocity(dt);
    case Mode::ProfilePosition:
      return profile_position(dt);
    case Mode::Homing:
      return home(dt);
    default:
      return follow_actual();
  }
}

/// The torque that is asked for, within top speed and limit switches.
void Axis::push(double torque, double dt) {
  follow_actual();
  torque_nm_ = torque;
  const fieldbus::AxisPlantParameters& mechanics = shaft_.mechanics();
  const double top = mechanics.max_speed_rpm / 60 * mechanics.encoder.counts_per_revolution;
  const bool too_fast = std::abs(shaft_.velocity()) >= top && torque * shaft_.velocity() > 0;
  const double angle = shaft_.angle();
  limited_ = (torque > 0 && parameters_.switches.at_positive_limit(angle)) ||
             (torque < 0 && parameters_.switches.at_negative_limit(angle));
  // Into a limit switch it brakes instead, as far as that does not turn it round within the step.
  if (limited_) {
    torque_nm_ = std::clamp(shaft_.nm_to_rest(dt), -mechanics.rated_torque_nm, mechanics.rated_torque_nm);
  }
  if (too_fast) torque_nm_ = 0;
}

void Axis::profile_velocity(double dt) {
  const bool halt = parameters_.halts();
  const double wanted = halt ? 0 : parameters_.target_velocity;
  const bool slows = std::abs(wanted) < std::abs(demand_.velocity) || wanted * demand_.velocity < 0;
  const Braking by = halt ? parameters_.halting : Braking::SlowDown;
  const double slow_down = shaft_.deceleration(by, parameters_.deceleration, parameters_.quick_stop);
  demand_.ramp(wanted, slows ? slow_down : parameters_.acceleration, dt);
}

void Axis::profile_position(double dt) {
  if (parameters_.halts()) return ramp_to_rest(parameters_.halting, parameters_.deceleration, dt);
  const double target = std::clamp(targets_.target(), parameters_.least_position, parameters_.most_position);
  limited_ = target != targets_.target();
  const bool arrived =
      demand_.approach(target, parameters_.velocity, parameters_.acceleration, parameters_.deceleration, dt);
  if (arrived && targets_.arrive()) watch_.leave_target();
}

/// While bit 4 of the controlword is on; else it comes to rest, and stays.
void Axis::interpolate(double dt) {
  const bool halt = parameters_.halts();
  if ((parameters_.controlword & 0x10) != 0 && !halt) {
    return line_.follow(demand_, parameters_.least_position, parameters_.most_position, dt);
  }
  ramp_to_rest(halt ? parameters_.halting : Braking::SlowDown, parameters_.deceleration, dt);
  line_.stay(demand_.position);
}

void Axis::home(double dt) {
  const double velocity = home_search_.step(parameters_, shaft_, standing());
  if (parameters_.halts()) {
    ramp_to_rest(parameters_.halting, parameters_.homing_acceleration, dt);
  } else {
    demand_.ramp(velocity, parameters_.homing_acceleration, dt);
  }
  if (!home_search_.found()) return;
  // Zero lies at home plus the home offset (607Ch); what the loops follow moves with it.
  const double shift = -parameters_.home_offset - shaft_.position();
  shaft_.shift_zero(shift);
  demand_.position += shift;
  targets_.stay(demand_.position);
  line_.stay(demand_.position);
}

void Axis::ramp_to_rest(Braking by, double slow_down, double dt) {
  demand_.ramp(0, shaft_.deceleration(by, slow_down, parameters_.quick_stop), dt);
}

/// Into a closed limit switch no demand goes on: it comes to rest on the quick stop's deceleration and stays.
void Axis::stop_at_limits(const Demand& before, double dt) {
  const double angle = shaft_.angle();
  const bool into = (demand_.velocity > 0 && parameters_.switches.at_positive_limit(angle)) ||
                    (demand_.velocity < 0 && parameters_.switches.at_negative_limit(angle));
  if (!into) return;
  limited_ = true;
  demand_ = before;
  demand_.ramp(0, parameters_.quick_stop, dt);
}

}  // namespace rmac::vdrive
