#include "servo/spindles/spindle_loop.hpp"

#include <algorithm>
#include <cmath>

#include "rmac/motion/servo/servo_bus.hpp"

namespace rmac {

namespace {

constexpr double kDegreesPerTurn = 360;
constexpr double kDegSPerRpm = kDegreesPerTurn / 60;
constexpr double kTooFast = 1.2;
constexpr int kCyclesBeyond = 3;

bool cyclic(DriveMode mode) noexcept {
  return mode == DriveMode::CyclicSyncTorque || mode == DriveMode::CyclicSyncVelocity;
}

}  // namespace

Expected<> check_spindle(const ServoSpindle& spindle, const std::string& who) {
  const auto refuse = [&who](const std::string& why) { return failure(MinorCode::InvalidParameterValue, who + why); };
  const std::string mode = std::to_string(static_cast<int>(spindle.mode));
  const bool takes_torque = spindle.mode == DriveMode::CyclicSyncTorque;
  if (!cyclic(spindle.mode) && spindle.mode != DriveMode::ProfileVelocity) {
    return refuse(": its drive is in mode " + mode +
                  ", which no spindle can be turned in; allowed are 3, 9 and 10 (profile velocity, cyclic synchronous "
                  "velocity and torque)");
  }
  if (takes_torque && !spindle.law) {
    return refuse(
        ": its drive takes a torque (mode 10), and there is no servo law to make it; choose one "
        "(SetMechanismSpindleServoControlLaw), or put the drive in mode 3");
  }
  if (!takes_torque && spindle.law) {
    return refuse(": it has a servo law, but its drive closes its speed loop itself (mode " + mode +
                  "); leave the law out, or put the drive in torque mode (10)");
  }
  if (!takes_torque && spindle.method != ControlMethod::Velocity) {
    return refuse(
        ": its drive follows speeds itself (mode " + mode +
        ") and cannot be held to an angle; choose DMAC_VELOCITY_CONTROL, or put the drive in torque mode (10)");
  }
  if (spindle.method == ControlMethod::Force) {
    return refuse(
        ": nothing asks a spindle for a force; choose DMAC_VELOCITY_CONTROL or DMAC_POSITION_CONTROL, and bound its "
        "torque by MaxTorque");
  }
  const DriveScale& scale = spindle.scale;
  if (!(spindle.max_speed_rpm >= 0) || !(scale.rated_torque_nm >= 0) || std::abs(scale.direction) != 1) {
    return refuse(": its largest speed and its rated torque must be 0 or above, its direction 1 or -1");
  }
  if (takes_torque && !(scale.counts_per_revolution > 0 && scale.rated_torque_nm > 0 && spindle.max_torque_nm > 0)) {
    return refuse(
        ": its drive takes a torque (mode 10), for which CountsPerRevolution, RatedTorque and MaxTorque must be "
        "above 0");
  }
  if (cyclic(spindle.mode) && !(spindle.max_acceleration_rpm_s > 0)) {
    return refuse(": its drive is told a speed or torque each cycle (mode " + mode +
                  "), for which MaxAcceleration must be "
                  "above 0");
  }
  if (spindle.method == ControlMethod::Position && !(spindle.max_following_error_deg > 0)) {
    return refuse(": under position control it needs a MaxFollowingError above 0");
  }
  return {};
}

SpindleLoop::SpindleLoop(const ServoSpindle& spindle, double period_s) noexcept
    : part_(spindle),
      period_s_(period_s),
      tells_torque_(spindle.bus->interface->tells_torque(spindle.axis)),
      turns_(spindle.scale, period_s),
      overload_(spindle.speed_tolerance_rpm, spindle.speed_timeout_s, period_s) {
  if (part_.law) part_.law->set_effort_limit(part_.max_torque_nm);
}

double SpindleLoop::angle_deg() const noexcept {
  return shaft_turns(part_.scale, turns_.counts()) * kDegreesPerTurn;
}

void SpindleLoop::read(const DriveFeedback& words) noexcept {
  measured_nm_ = shaft_nm(part_.scale, words.torque_permille);
  if (has_encoder()) {
    turns_.read(words);
    rpm_ = turns_.rpm();
  } else {
    rpm_ = part_.scale.direction * words.velocity_rpm;
  }
}

double SpindleLoop::following_error() const noexcept {
  return live_ && part_.method == ControlMethod::Position ? angle_set_deg_ - angle_deg() : 0;
}

ServoInput SpindleLoop::input() const noexcept {
  const double effort = tells_torque_ ? measured_nm_ : torque_nm_;
  if (part_.method == ControlMethod::Position) {
    return {.position_setpoint = following_error(),
            .velocity_setpoint = rpm_set_ * kDegSPerRpm,
            .acceleration_setpoint = rpm_per_s_set_ * kDegSPerRpm,
            .velocity = rpm_ * kDegSPerRpm,
            .effort = effort,
            .effort_measured = tells_torque_,
            .period_s = period_s_};
  }
  return {.position_setpoint = rpm_set_,
          .velocity_setpoint = rpm_per_s_set_,
          .position = rpm_,
          .velocity = turns_.rpm_per_s(),
          .effort = effort,
          .effort_measured = tells_torque_,
          .period_s = period_s_};
}

bool SpindleLoop::follow(double wanted_rpm, const DriveCommand& words) noexcept {
  if (part_.mode == DriveMode::ProfileVelocity) {
    rpm_set_ = wanted_rpm;
    return true;
  }
  // Before its speed is known a spindle that another mechanism turned goes on as it was told.
  if (has_encoder() && !turns_.settled()) {
    torque_nm_ = shaft_nm(part_.scale, words.target_torque_permille);
    return true;
  }
  if (!live_) {
    live_ = true;
    rpm_set_ = rpm_;
    rpm_per_s_set_ = 0;
    angle_set_deg_ = has_encoder() ? angle_deg() : 0;
    if (part_.law) part_.law->engage(input(), shaft_nm(part_.scale, words.target_torque_permille));
  } else {
    const double most = part_.max_acceleration_rpm_s * period_s_;
    const double change = std::clamp(wanted_rpm - rpm_set_, -most, most);
    rpm_set_ += change;
    rpm_per_s_set_ = change / period_s_;
    angle_set_deg_ += rpm_set_ * period_s_ * kDegSPerRpm;
  }
  if (!part_.law) return true;
  const double torque = part_.law->update(input());
  if (!std::isfinite(torque)) return false;
  torque_nm_ = std::clamp(torque, -part_.max_torque_nm, part_.max_torque_nm);
  return true;
}

void SpindleLoop::let_go() noexcept {
  live_ = false;
  rpm_set_ = rpm_per_s_set_ = torque_nm_ = 0;
}

void SpindleLoop::command(DriveCommand& words) const noexcept {
  words.mode = part_.mode;
  const double speed = part_.scale.direction * rpm_set_;
  words.target_velocity_rpm = part_.mode == DriveMode::ProfileVelocity ? std::round(speed) : speed;
  if (!has_encoder()) return;
  words.target_torque_permille = torque_word(part_.scale, torque_nm_);
}

bool SpindleLoop::too_fast() noexcept {
  const bool beyond = has_encoder() && std::abs(rpm_) > kTooFast * part_.max_speed_rpm;
  fast_cycles_ = beyond ? fast_cycles_ + 1 : 0;
  return fast_cycles_ >= kCyclesBeyond;
}

}  // namespace rmac
