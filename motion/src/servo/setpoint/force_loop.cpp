#include "servo/setpoint/force_loop.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

void ForceLoop::restart() noexcept {
  state_ = ContactState::Holding;
  velocity_ = integral_ = searched_ = 0;
}

double ForceLoop::step(double wanted, double measured) noexcept {
  const double most = control_.max_acceleration * period_s_;
  velocity_ += std::clamp(target(wanted, measured) - velocity_, -most, most);
  if (state_ == ContactState::Approaching) searched_ += std::abs(velocity_) * period_s_;
  return velocity_;
}

double ForceLoop::target(double wanted, double measured) noexcept {
  if (wanted == 0) {
    state_ = ContactState::Holding;
    integral_ = 0;
    return 0;
  }
  const double towards = std::copysign(1.0, wanted);
  const double pushed = towards * measured;
  if (state_ == ContactState::Approaching && pushed >= control_.contact_force) {
    state_ = ContactState::Touching;
    integral_ = 0;
  } else if (state_ != ContactState::Approaching &&
             (state_ == ContactState::Holding || pushed < control_.contact_force / 2)) {
    state_ = pushed >= control_.contact_force ? ContactState::Touching : ContactState::Approaching;
    integral_ = searched_ = 0;
  }
  if (state_ == ContactState::Approaching) return towards * control_.approach_speed;

  const double error = wanted - measured;
  const double unbounded = control_.gain * error + integral_;
  const double speed = std::clamp(unbounded, -control_.max_speed, control_.max_speed);
  // The integral stands still where it would drive a bounded speed further.
  if (speed == unbounded || unbounded * error < 0) {
    integral_ += control_.gain * error * period_s_ / control_.reset_time_s;
  }
  return speed;
}

Expected<> check_force_control(const ForceControl& control, const std::string& who) {
  for (const auto& [name, value] : {std::pair{"an approach speed", control.approach_speed},
                                    {"a contact force", control.contact_force},
                                    {"a gain", control.gain},
                                    {"a reset time", control.reset_time_s},
                                    {"a largest speed", control.max_speed},
                                    {"a largest force", control.max_force},
                                    {"a way to search", control.max_search},
                                    {"a largest acceleration", control.max_acceleration}}) {
    if (value > 0 && std::isfinite(value)) continue;
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " is under force control, which needs " + name + " above 0");
  }
  if (control.contact_force < control.max_force) return {};
  return failure(MinorCode::InvalidParameterValue,
                 "servo loop: " + who + ": the force that tells contact must be below the largest one");
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
