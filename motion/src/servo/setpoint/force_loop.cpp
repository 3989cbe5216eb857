#include "servo/setpoint/force_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace rmac {

namespace {

/// A joint that pushes is damped by its law up to a part this many times as stiff as a soft one, the less the stiffer
/// it is: beyond, joint and part swing so fast that the loop's delay turns damping round. Above this part of the
/// largest speed all of it brakes.
constexpr double kUndamped = 4, kSlowPart = 0.5;
/// Where the drives close the joint's loop: how fast the loop of force around it may be, the stiffness that is assumed
/// before one was seen (N/mm, N·m/deg), and the reset time, in times that the loop takes.
constexpr double kAround_rad_s = 20, kStiffest = 50'000, kReset = 8;
/// Who is pushed until it proves soft is pushed again once it is so much stiffer than that.
constexpr double kClearly = 1.5;
/// Part of the largest force by which the effort changes at most while not a digit of the measured force does.
constexpr double kUnanswered = 0.25;
/// Part of the wanted force up to which an error is taken for that of a surface which rises, and not of a new force.
constexpr double kSteady = 0.1;

double stiffest(const ForceControl& control) noexcept {
  return control.stiffness > 0 ? control.stiffness : kStiffest;
}

std::string rounded(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, value >= 100 ? "%.0f" : "%.3g", value);
  return buffer;
}

/// What moves comes upon the part at its approach speed, and nothing stops it within the first cycles: v √(k m).
Expected<> check_impact(const ForceControl& control, const std::string& who) {
  const double stiffness = stiffest(control);
  const double most = control.max_force / std::sqrt(stiffness * control.mass);
  if (control.approach_speed <= most) return {};
  return failure(MinorCode::InvalidParameterValue,
                 "servo loop: " + who + " approaches at " + rounded(control.approach_speed) +
                     ", and would press its part with " + rounded(control.max_force * control.approach_speed / most) +
                     " at a stiffness of " + rounded(stiffness) + ", beyond its largest force of " +
                     rounded(control.max_force) + "; let it approach at " + rounded(most) +
                     " or slower, or say what stiffness its parts have");
}

}  // namespace

void ForceLoop::restart() noexcept {
  search_.restart();
  velocity_ = integral_ = added_ = 0;
  pushes_ = false;
}

void ForceLoop::step(const Seen& seen) noexcept {
  const bool near = state() == ContactState::Touching || search_.bounces();
  search_.step(seen.wanted, seen.measured, velocity_);
  if (state() == ContactState::Touching) {
    if (!near) stiffness_.forget();
    stiffness_.step(seen.position, seen.measured);
    choose();
  } else if (!search_.bounces()) {
    // A position loop may swing on a part that it has to be pushed at.
    if (pushes_ && state() == ContactState::Holding) search_.let_go();
    pushes_ = false;
    integral_ = 0;
  }
  if (pushes_) {
    velocity_ = seen.velocity;
    if (search_.settled()) push(seen);
  } else {
    const double most = control_.max_acceleration * period_s_;
    velocity_ += std::clamp(target(seen) - velocity_, -most, most);
  }
}

double ForceLoop::stiff() const noexcept {
  return stiffness_.value().value_or(stiffest(control_));
}

void ForceLoop::choose() noexcept {
  const bool pushes = stiff() > (pushes_ ? soft_ : kClearly * soft_);
  if (pushes == pushes_) return;
  pushes_ = pushes;
  integral_ = added_ = added_at_reading_ = 0;
  effort_.begin();
}

double ForceLoop::target(const Seen& seen) noexcept {
  if (state() != ContactState::Touching) return search_.velocity();
  const double error = seen.wanted - seen.measured;
  const double gain = this->gain();
  const double unbounded = gain * error + integral_;
  const double speed = std::clamp(unbounded, -control_.max_speed, control_.max_speed);
  // The integral stands still where it would drive a bounded speed further.
  if (speed == unbounded || unbounded * error < 0) {
    const double reset_s = control_.reset_time_s > 0 ? control_.reset_time_s : kReset / kAround_rad_s;
    integral_ += gain * error * period_s_ / reset_s;
  }
  return speed;
}

double ForceLoop::gain() const noexcept {
  const double found = kAround_rad_s / stiff();
  return control_.gain > 0 ? std::min(control_.gain, found) : found;
}

void ForceLoop::push(const Seen& seen) noexcept {
  const double asked = control_.gain > 0 && stiffness_.value() ? control_.gain * *stiffness_.value()
                                                               : std::numeric_limits<double>::infinity();
  added_ =
      effort_.step(seen.wanted - seen.measured, {.bandwidth_rad_s = asked,
                                                 .reset_time_s = control_.reset_time_s,
                                                 .largest_error = kSteady * std::abs(seen.wanted),
                                                 .no_more = seen.bounded > 0 || seen.velocity > control_.max_speed,
                                                 .no_less = seen.bounded < 0 || seen.velocity < -control_.max_speed});
  if (seen.measured != reading_) {
    reading_ = seen.measured;
    added_at_reading_ = added_;
  }
}

bool ForceLoop::sensor_hangs() const noexcept {
  return pushes_ && std::abs(added_ - added_at_reading_) > kUnanswered * control_.max_force;
}

double ForceLoop::damped(double velocity) const noexcept {
  const double slow = kSlowPart * control_.max_speed;
  const double damped = std::clamp((kUndamped * soft_ / stiff() - 1) / (kUndamped - 1), 0.0, 1.0);
  return velocity - (1 - damped) * std::clamp(velocity, -slow, slow);
}

Expected<> check_force_control(const ForceControl& control, const std::string& who) {
  for (const auto& [name, value] : {std::pair{"an approach speed", control.approach_speed},
                                    {"a contact force", control.contact_force},
                                    {"a largest speed", control.max_speed},
                                    {"a largest force", control.max_force},
                                    {"a way to search", control.max_search},
                                    {"a largest acceleration", control.max_acceleration}}) {
    if (value > 0 && std::isfinite(value)) continue;
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " is under force control, which needs " + name + " above 0");
  }
  if (!(control.contact_force < control.max_force)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + ": the force that tells contact must be below the largest one");
  }
  return check_impact(control, who);
}

const char* to_string(ContactState state) noexcept {
  switch (state) {
    case ContactState::None:
      return "None";
    case ContactState::Holding:
      return "Holding";
    case ContactState::Approaching:
      return "Approaching";
    case ContactState::Touching:
      return "Touching";
  }
  return "Unknown";
}

}  // namespace rmac
