#include "servo/gantry/gantries.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "rmac/motion/drive_scale.hpp"

namespace rmac {

namespace {

constexpr double kStep = 1e-3;    // mm or degrees, by which a joint is moved to see what its motors do
constexpr double kRateS = 0.001;  // low-pass of the rate
constexpr double kBringsBackS = 0.2;
constexpr double kGoesOn = 0.05;  // of MaxSkew, that a joint goes while an encoder stays
constexpr double kGoesOnDigits = 5;
constexpr double kStaysS = 0.005;     // to the last digit
constexpr double kBreaksLoose = 0.2;  // of its share of MaxEffort, by which its own changes: twice the friction
constexpr double kMoreThanUsual = 2;
constexpr double kMargin = 0.2;     // of MaxSkew, beyond a skew that there was before power
constexpr double kMostAtPower = 2;  // times MaxSkew: with more there is none

/// The joint has several motors, and they move no other one.
bool side_by_side(const Wiring& wiring, std::size_t joint) {
  const IndexSet motors = wiring.actuators_of(joint);
  if (std::popcount(motors) < 2) return false;
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    if (has(motors, i) && wiring.sense(i) == 0) return false;
  }
  return true;
}

}  // namespace

Gantries::Gantries(const ServoLoopParts& parts, const Wiring& wiring) : parts_(parts), period_s_(parts.period_s) {
  if (parts.virtual_mode) return;
  const ActuatorMap& map = *parts.actuator_map;
  using Values = std::array<double, kMaxJoints>;
  const auto joints_of = [&](Values& all) { return std::span(all).first(wiring.joints()); };
  const auto motors_of = [&](Values& all) { return std::span(all).first(wiring.actuators()); };
  Values zero{}, zero_at{}, zero_from{};  // shafts where all counters stand at 0
  for (std::size_t i = 0; i < wiring.actuators(); ++i) zero[i] = shaft_rad(parts.actuators[i].scale, 0);
  map.joint_positions(motors_of(zero), joints_of(zero_at));
  map.actuator_positions(joints_of(zero_at), motors_of(zero_from));
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    if (!side_by_side(wiring, j)) continue;
    const ServoJoint& joint = parts.joints[j];
    Values at{}, effort{}, from{}, to{}, torque{};
    effort[j] = 1;
    map.actuator_efforts(joints_of(at), joints_of(effort), motors_of(torque));
    map.actuator_positions(joints_of(at), motors_of(from));
    at[j] = kStep;
    map.actuator_positions(joints_of(at), motors_of(to));
    Joint made{j,
               joint.gantry.value_or(Gantry{.max_skew = joint.max_following_error}),
               0,
               OscillationWatch(joint, j, period_s_),
               {}};
    int soonest = kMostAnswerDelay;
    for (std::size_t i = 0; i < wiring.actuators(); ++i) {
      if (has(wiring.actuators_of(j), i)) soonest = std::min<int>(soonest, wiring.actuator_delays()[i]);
    }
    for (std::size_t i = 0; i < wiring.actuators(); ++i) {
      if (!has(wiring.actuators_of(j), i)) continue;
      const double per_rad = kStep / (to[i] - from[i]);
      const double late_s = (wiring.actuator_delays()[i] - soonest) * period_s_;
      made.motors.push_back({i, parts.actuators[i].scale.direction, per_rad, late_s, zero[i] - zero_from[i],
                             EffortFilter(joint.mechanics, period_s_),
                             EncoderDigits(dead_stop(joint.bounds.stop_deceleration, period_s_), period_s_)});
      made.power_a_speed += torque[i] / per_rad;
    }
    joints_.push_back(std::move(made));
  }
}

Gantries::Joint* Gantries::of(std::size_t joint) noexcept {
  const auto found = std::ranges::find(joints_, joint, &Joint::joint);
  return found == joints_.end() ? nullptr : &*found;
}

const Gantries::Motor* Gantries::motor(std::size_t actuator) const noexcept {
  for (const Joint& joint : joints_) {
    const auto found = std::ranges::find(joint.motors, actuator, &Motor::actuator);
    if (found != joint.motors.end()) return &*found;
  }
  return nullptr;
}

void Gantries::read(std::span<const double> shafts, std::span<const double> rad_s) noexcept {
  if (empty()) return;
  const ActuatorMap& map = *parts_.actuator_map;
  const std::size_t joints = parts_.joints.size(), actuators = shafts.size();
  std::array<double, kMaxJoints> now{}, moved{}, from{}, to{};
  std::copy(shafts.begin(), shafts.end(), now.begin());
  for (const Joint& joint : joints_) {
    for (const Motor& motor : joint.motors) now[motor.actuator] += rad_s[motor.actuator] * motor.late_s;
  }
  map.joint_positions({now.data(), actuators}, {at_.data(), joints});
  moved = at_;
  for (const Joint& joint : joints_) moved[joint.joint] += kStep;
  map.actuator_positions({at_.data(), joints}, {from.data(), actuators});
  map.actuator_positions({moved.data(), joints}, {to.data(), actuators});
  for (Joint& joint : joints_) {
    for (Motor& motor : joint.motors) {
      motor.way = shafts[motor.actuator] * motor.per_rad_at_home;
      motor.apart = now[motor.actuator] - from[motor.actuator];
      motor.per_rad = kStep / (to[motor.actuator] - from[motor.actuator]);
      ahead_[motor.actuator] = motor.belongs ? (motor.apart - *motor.belongs) * motor.per_rad : 0;
    }
  }
}

double Gantries::skew(const Joint& joint) const noexcept {
  double foremost = ahead_[joint.motors.front().actuator], hindmost = foremost;
  for (const Motor& motor : joint.motors) {
    foremost = std::max(foremost, ahead_[motor.actuator]);
    hindmost = std::min(hindmost, ahead_[motor.actuator]);
  }
  return foremost - hindmost;
}

void Gantries::forget(IndexSet actuators) noexcept {
  for (Joint& joint : joints_) {
    for (Motor& motor : joint.motors) {
      if (!has(actuators, motor.actuator)) continue;
      motor.belongs.reset();
      ahead_[motor.actuator] = 0;
    }
  }
}

void Gantries::start(Joint& joint, bool amiss) noexcept {
  const bool known = std::ranges::all_of(joint.motors, [](const Motor& motor) { return motor.belongs.has_value(); });
  for (Motor& motor : joint.motors) {
    if (!known) {
      motor.belongs = motor.apart;
      ahead_[motor.actuator] = 0;
    }
    motor.before = ahead_[motor.actuator];
    if (amiss || !known) motor.left = motor.before;
    motor.rate = motor.held = 0;
    motor.filter.engage(-joint.given.stiffness * (motor.before - motor.left));
  }
  joint.allowed = std::min(skew(joint) + kMargin * joint.given.max_skew, kMostAtPower * joint.given.max_skew);
  joint.beyond.restart();
  joint.oscillation.rest();
  joint.begins = true;
}

void Gantries::engage(std::size_t joint) noexcept {
  if (Joint* const found = of(joint)) start(*found, true);
}

void Gantries::go_on(std::size_t joint) noexcept {
  if (Joint* const found = of(joint)) start(*found, false);
}

void Gantries::note_digits(Motor& motor, const Joint& joint, const Seen& seen) const noexcept {
  const double effort = seen.effort / static_cast<double>(joint.motors.size()) + motor.held;
  if (joint.begins) {
    motor.digits.begin(motor.way, effort);
  } else if (seen.answered) {
    motor.digits.note(motor.way, effort);
  }
  if (joint.begins || motor.digits.same() == 0) motor.still_since = at_[joint.joint];
}

bool Gantries::froze(const Motor& motor, const Joint& joint) const noexcept {
  const double least = std::max(kGoesOnDigits * motor.digits.digit(), kGoesOn * joint.given.max_skew);
  if (std::abs(at_[joint.joint] - motor.still_since) <= least) return false;
  const double share = parts_.joints[joint.joint].max_effort / static_cast<double>(joint.motors.size());
  const double enough = std::max(kBreaksLoose * share, kMoreThanUsual * motor.digits.usual_change());
  const bool pushed = motor.digits.effort_change() > enough;
  return motor.digits.froze() || (pushed && static_cast<double>(motor.digits.same()) * period_s_ >= kStaysS);
}

void Gantries::watch_skew(Joint& joint, const Seen& seen, FaultSink& faults) noexcept {
  const double now = skew(joint);
  // What was amiss before power may come back; it may not grow.
  joint.allowed = std::min(joint.allowed, now + kMargin * joint.given.max_skew);
  const double bound = std::max(joint.given.max_skew, joint.allowed);
  const bool too_far = joint.begins && now > bound;
  if (!joint.beyond.step(now, bound) && !too_far) return;
  // What is blocked, weak or not told lags. At rest it is the one that is farthest from its place.
  const auto off = [&](const Motor& motor) {
    const double away = seen.wanted - seen.position - ahead_[motor.actuator];
    return seen.wanted_speed == 0 ? std::abs(away) : std::copysign(away, away * seen.wanted_speed);
  };
  const Motor& worst = *std::ranges::max_element(joint.motors, {}, off);
  faults.raise(
      {ServoFault::Kind::Skewed, ServoFault::Part::Actuator, static_cast<std::uint32_t>(worst.actuator), now, bound});
}

void Gantries::watch(std::size_t joint, const Seen& seen, FaultSink& faults) noexcept {
  Joint* const found = of(joint);
  if (found == nullptr) return;
  for (Motor& motor : found->motors) {
    motor.left *= 1 - period_s_ / (period_s_ + kBringsBackS);
    const auto index = static_cast<std::uint32_t>(motor.actuator);
    const double ahead = ahead_[motor.actuator];
    if (!std::isfinite(ahead)) {
      faults.raise({ServoFault::Kind::NotANumber, ServoFault::Part::Actuator, index, ahead, 0});
      continue;
    }
    note_digits(motor, *found, seen);
    if (froze(motor, *found)) {
      faults.raise({ServoFault::Kind::EncoderFrozen, ServoFault::Part::Actuator, index,
                    static_cast<double>(motor.digits.same()) * period_s_, motor.digits.effort_change()});
    }
  }
  watch_skew(*found, seen, faults);
  const Motor& first = found->motors.front();
  found->oscillation.step({.effort = first.held * static_cast<double>(found->motors.size()),
                           .answer_delay = seen.answer_delay,
                           .position = ahead_[first.actuator],
                           .acceleration_set = seen.wanted_acceleration},
                          faults);
  found->begins = false;
}

void Gantries::hold(std::size_t joint, double effort) noexcept {
  Joint* const found = of(joint);
  if (found == nullptr) return;
  const auto& [max_skew, stiffness, damping] = found->given;
  double largest = 0;
  for (Motor& motor : found->motors) {
    const double ahead = ahead_[motor.actuator];
    motor.rate += ((ahead - motor.before) / period_s_ - motor.rate) * period_s_ / (period_s_ + kRateS);
    motor.before = ahead;
    motor.held = motor.filter.update(-stiffness * (ahead - motor.left) - damping * motor.rate);
    largest = std::max(largest, std::abs(motor.held));
  }
  // All by the same part, so that they push their joint nowhere; no motor beyond its share. More than what MaxSkew asks
  // for helps nothing, and would tear where a reading is wrong.
  const double max_effort = parts_.joints[joint].max_effort;
  const double free = std::max(0.0, max_effort - std::abs(effort)) / static_cast<double>(found->motors.size());
  const double most = stiffness > 0 ? std::min(free, stiffness * max_skew) : free;
  const double part = largest > most ? most / largest : 1;
  for (Motor& motor : found->motors) {
    motor.held *= part;
    const double torque = motor.held * found->power_a_speed * motor.per_rad;
    torque_[motor.actuator] = std::isfinite(torque) ? torque : 0;
  }
}

void Gantries::place(std::span<double> aims) const noexcept {
  for (const Joint& joint : joints_) {
    for (const Motor& motor : joint.motors) {
      if (motor.belongs) aims[motor.actuator] += *motor.belongs + motor.left / motor.per_rad_at_home;
    }
  }
}

std::optional<ServoHandover::Beside> Gantries::beside(std::size_t actuator) const noexcept {
  const Motor* const found = motor(actuator);
  if (found == nullptr || !found->belongs) return std::nullopt;
  return ServoHandover::Beside{found->direction * (*found->belongs - found->at_zero_counts),
                               found->direction * found->left / found->per_rad_at_home};
}

void Gantries::take_over(std::size_t actuator, const ServoHandover::Beside& beside) noexcept {
  for (Joint& joint : joints_) {
    for (Motor& motor : joint.motors) {
      if (motor.actuator != actuator) continue;
      motor.belongs = motor.direction * beside.belongs_rad + motor.at_zero_counts;
      motor.left = motor.direction * beside.left_rad * motor.per_rad_at_home;
    }
  }
}

Expected<> check_gantries(const ServoLoopParts& parts, const Wiring& wiring) {
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const std::optional<Gantry>& gantry = parts.joints[j].gantry;
    if (!gantry) continue;
    const auto refuse = [j](const char* why) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: joint " + std::to_string(j) + " has a Gantry, and " + why);
    };
    if (!side_by_side(wiring, j)) return refuse("not several motors of its own; take it out");
    if (!(gantry->max_skew > 0) || !(gantry->stiffness >= 0) || !(gantry->damping >= 0)) {
      return refuse("a MaxSkew above 0 is needed, a stiffness and a damping of 0 or more");
    }
    if (wiring.follows_itself(j) && (gantry->stiffness > 0 || gantry->damping > 0)) {
      return refuse("drives that follow their positions themselves, which holds them; leave out Stiffness and Damping");
    }
  }
  return {};
}

}  // namespace rmac
