#include <cmath>
#include <numbers>

#include "gateway/simulators/vdrive/axis_parameters.hpp"

namespace rmac::vdrive {
namespace {

constexpr double kStep_s = 125e-6;  // of the drive's own loops
constexpr double kStandingRevolutionsPerS = 0.02;

constexpr std::uint16_t kFollowingError = 0x8611;
constexpr std::uint16_t kOvertemperature = 0x4310;

unsigned bit(unsigned number, bool set) {
  return set ? 1U << number : 0U;
}

}  // namespace

Axis::Axis(Dictionary& dictionary, const fieldbus::AxisPlantParameters& plant, Report report)
    : dictionary_(dictionary),
      mechanics_(plant),
      plant_(plant),
      report_(std::move(report)),
      parameters_(std::make_unique<Parameters>()) {
  reset();
}

Axis::~Axis() = default;

void Axis::reset() {
  *parameters_ = parameters();
  power_ = PowerStates();
  power_.proceed(true, parameters_->options);
  homing_.stop();
  mode_ = Mode::None;
  offset_ = encoder_shift_ = 0;
  probes_ = {};
  next_target_.reset();
  acknowledges_ = new_setpoint_before_ = homes_before_ = at_target_ = following_error_ = false;
  dictionary_.set(0x6076, std::llround(mechanics_.rated_torque_nm * 1000));
  dictionary_.set({0x608F, 1}, std::llround(mechanics_.counts_per_revolution));
  follow_actual();
  publish();
}

double Axis::counts_per_radian() const {
  return mechanics_.counts_per_revolution / (2 * std::numbers::pi);
}
double Axis::shaft() const {
  return plant_.angle_rad() * counts_per_radian();
}
double Axis::position() const {
  return told(shaft());
}
double Axis::told(double shaft) const {
  return std::floor(shaft) + offset_ + encoder_shift_;
}
double Axis::velocity() const {
  return plant_.speed_rad_s() * counts_per_radian();
}
bool Axis::standing() const {
  return demand_.velocity == 0 && std::abs(velocity()) < kStandingRevolutionsPerS * mechanics_.counts_per_revolution;
}
bool Axis::at_negative_limit() const {
  return shaft() <= parameters_->negative_limit;
}
bool Axis::at_positive_limit() const {
  return shaft() >= parameters_->positive_limit;
}

double Axis::units_per_count() const {
  const auto ratio = [this](std::uint16_t index) {
    return static_cast<double>(dictionary_.number(index, 1)) / static_cast<double>(dictionary_.number(index, 2));
  };
  return ratio(0x6092) / (ratio(0x608F) * ratio(0x6091));
}
double Axis::position_units() const {
  return (dictionary_.number(0x607E) & 0x80) != 0 ? -units_per_count() : units_per_count();
}
double Axis::velocity_units() const {
  return (dictionary_.number(0x607E) & 0x40) != 0 ? -units_per_count() : units_per_count();
}
double Axis::target_position() const {
  return static_cast<double>(dictionary_.number(0x607A)) / position_units();
}

Axis::Parameters Axis::parameters() const {
  const auto of = [this](std::uint16_t index, std::uint8_t sub = 0) {
    return static_cast<double>(dictionary_.number(index, sub));
  };
  const auto counts = [&, units = units_per_count()](std::uint16_t index, std::uint8_t sub = 0) {
    return of(index, sub) / units;
  };
  const bool has_limits = of(0x607D, 1) < of(0x607D, 2);
  const double one_end = of(0x607D, 1) / position_units(), other_end = of(0x607D, 2) / position_units();
  const double target_velocity = of(0x60FF) / velocity_units() + counts(0x60B1);
  const double most_permille = std::min(of(0x6072), 1000 * mechanics_.peak_torque_nm / mechanics_.rated_torque_nm);
  return {.velocity = std::min(counts(0x6081), counts(0x607F)),
          .acceleration = counts(0x6083),
          .deceleration = counts(0x6084),
          .quick_stop = counts(0x6085),
          .homing_acceleration = counts(0x609A),
          .fast = counts(0x6099, 1),
          .slow = counts(0x6099, 2),
          .top_velocity = counts(0x607F),
          .target_velocity = std::clamp(target_velocity, -counts(0x607F), counts(0x607F)),
          .torque_slope = of(0x6087) / 1000 * mechanics_.rated_torque_nm,
          .target_torque = (of(0x6071) + of(0x60B2)) / 1000 * mechanics_.rated_torque_nm,
          .most_torque = most_permille / 1000 * mechanics_.rated_torque_nm,
          .least_position = has_limits ? std::min(one_end, other_end) : -2147483648.0,
          .most_position = has_limits ? std::max(one_end, other_end) : 2147483647.0,
          .window = counts(0x6067),
          .window_s = of(0x6068) / 1000,
          .velocity_window = counts(0x606D),
          .velocity_window_s = of(0x606E) / 1000,
          .error_window = of(0x6065) < 4294967295.0 ? counts(0x6065) : 4294967295.0,
          .error_s = of(0x6066) / 1000,
          .negative_limit = of(0x2000, 1),
          .positive_limit = of(0x2000, 2),
          .cam_from = of(0x2000, 3),
          .cam_to = of(0x2000, 4),
          .index = of(0x2000, 5),
          .touches_from = of(0x2000, 6),
          .touches_to = of(0x2000, 7),
          .home_offset = of(0x607C) / position_units(),
          .slow_velocity = counts(0x606F),
          .options = {.quick_stop = static_cast<int>(of(0x605A)),
                      .shutdown = static_cast<int>(of(0x605B)),
                      .disable_operation = static_cast<int>(of(0x605C)),
                      .fault_reaction = static_cast<int>(of(0x605E))},
          .halting = braking_of(static_cast<int>(of(0x605D))),
          .homing_method = static_cast<int>(of(0x6098)),
          .controlword = static_cast<std::uint16_t>(dictionary_.number(0x6040))};
}

void Axis::take(ObjectAddress object) {
  *parameters_ = parameters();
  if (object.index == 0x6040) take_controlword();
  if (object.index == 0x60B8) {
    const auto function = static_cast<unsigned>(dictionary_.number(0x60B8));
    probes_[0].set_function(function & 0xFFU);
    probes_[1].set_function(function >> 8 & 0xFFU);
  }
  const bool cyclic = object.index == 0x607A && mode_ == Mode::CyclicSyncPosition;
  if (cyclic || (object.index == 0x60C1 && mode_ == Mode::InterpolatedPosition)) {
    setpoint_ = static_cast<double>(dictionary_.number(object.index, object.sub)) / position_units();
    // 60C2h: value times ten to the index, in seconds.
    setpoint_left_s_ = static_cast<double>(dictionary_.number(0x60C2, 1)) *
                       std::pow(10.0, static_cast<double>(dictionary_.number(0x60C2, 2)));
  }
  if (object.index == 0x6060) {
    const Mode wanted = static_cast<Mode>(dictionary_.number(0x6060));
    if (wanted == mode_) return;
    mode_ = wanted;
    homing_.stop();
    next_target_.reset();
    acknowledges_ = at_target_ = homes_before_ = false;
    setpoint_ = target_ = demand_.position;
    setpoint_left_s_ = 0;
    profile_nm_ = torque_nm_;
  }
}

void Axis::take_controlword() {
  const auto word = static_cast<std::uint16_t>(dictionary_.number(0x6040));
  const bool was_powered = power_.powered();
  if (power_.control(word, parameters_->options)) report_(0);
  if (!was_powered && power_.powered()) follow_actual();
  const bool rises = (word & 0x10) != 0 && !new_setpoint_before_;
  new_setpoint_before_ = (word & 0x10) != 0;
  if (!power_.operating() || mode_ != Mode::ProfilePosition) {
    if (!new_setpoint_before_) acknowledges_ = false;
    return;
  }
  // The handshake of a new set-point (CiA 402-2, 10.2): taken on the rise of bit 4, acknowledged until it falls and
  // there is room for another.
  if (rises && (!next_target_ || (word & 0x20) != 0)) {
    const double written = target_position();
    const double from = next_target_ ? *next_target_ : target_;
    const double target = (word & 0x40) != 0 ? from + written : written;
    const bool at_once = (word & 0x20) != 0 || at_target_ || (!next_target_ && demand_.velocity == 0);
    if (at_once) {
      target_ = target;
      next_target_.reset();
      at_target_ = false;
    } else {
      next_target_ = target;
    }
    acknowledges_ = true;
  }
  if (!new_setpoint_before_ && !next_target_) acknowledges_ = false;
}

void Axis::trip(std::uint16_t error_code) {
  if (power_.state() == PowerStates::Fault || power_.state() == PowerStates::FaultReaction) return;
  power_.raise_fault(parameters_->options);
  report_(error_code);
}

void Axis::abort_connection() {
  constexpr std::uint16_t kHeartbeatError = 0x8130;
  power_.abort_connection(static_cast<int>(dictionary_.number(0x6007)), parameters_->options);
  if (power_.state() == PowerStates::FaultReaction) dictionary_.set(0x603F, kHeartbeatError);
}

void Axis::follow_actual() {
  demand_ = {.position = position(), .velocity = velocity(), .acceleration = 0};
  setpoint_ = target_ = demand_.position;
  setpoint_left_s_ = 0;
  integral_nm_ = mechanics_.gravity_nm;
  torque_nm_ = 0;
  index_turn_ = std::floor((shaft() - parameters_->index) / mechanics_.counts_per_revolution);
}

void Axis::advance(double duration_s) {
  if (duration_s <= 0) return;
  // A host that stood still for long would otherwise be busy for as long with what it missed.
  constexpr double kMostAtOnce_s = 0.5;
  const double bounded = std::min(duration_s, kMostAtOnce_s);
  const int steps = static_cast<int>(std::ceil(bounded / kStep_s - 1e-9));
  for (int i = 0; i < steps; ++i) step(*parameters_, bounded / steps);
}

void Axis::step(const Parameters& parameters, double dt) {
  if (overheated_) trip(kOvertemperature);
  const Demand before = demand_;
  const double shaft_before = shaft();
  limited_ = false;
  if (!power_.operating()) profile_nm_ = 0;
  if (power_.operating()) {
    operate(parameters, dt);
    const bool torque = mode_ == Mode::CyclicSyncTorque || mode_ == Mode::ProfileTorque || mode_ == Mode::None;
    if (!torque && mode_ != Mode::Homing) stop_at_limits(before, parameters, dt);
    if (!torque) torque_nm_ = loops(parameters, dt);
  } else if (power_.powered()) {
    // From what it does, not from what it was asked to do: a setpoint may have been out of reach.
    if (!braking_) demand_ = {.position = position(), .velocity = velocity(), .acceleration = 0};
    brake(parameters, dt);
  } else {
    follow_actual();
  }
  braking_ = power_.powered() && !power_.operating();
  torque_nm_ = std::clamp(torque_nm_, -parameters.most_torque, parameters.most_torque);
  plant_.advance(torque_nm_, !power_.powered(), dt);
  watch_touch_probes(shaft_before);
  watch(parameters, dt);
  power_.proceed(standing(), parameters_->options);
}

void Axis::watch(const Parameters& parameters, double dt) {
  const double error = std::abs(demand_.position - position());
  const bool follows = power_.operating() && (mode_ == Mode::CyclicSyncPosition || mode_ == Mode::ProfilePosition ||
                                              mode_ == Mode::InterpolatedPosition);
  constexpr double kOff = 4294967295.0;
  following_error_ = follows && parameters.error_window < kOff && error > parameters.error_window;
  following_error_s_ = following_error_ ? following_error_s_ + dt : 0;
  if (following_error_ && following_error_s_ > parameters.error_s) trip(kFollowingError);

  const bool halt = parameters.halts();
  bool within = false;
  double needed_s = 0;
  if (halt) {
    within = standing();
  } else if (mode_ == Mode::ProfilePosition) {
    within = !next_target_ && std::abs(target_ - position()) <= parameters.window;
    needed_s = parameters.window_s;
  } else if (mode_ == Mode::ProfileVelocity) {
    within = std::abs(parameters.target_velocity - velocity()) <= parameters.velocity_window;
    needed_s = parameters.velocity_window_s;
  }
  if (!halt && mode_ == Mode::ProfileTorque) within = profile_nm_ == parameters.target_torque;
  in_window_s_ = within ? in_window_s_ + dt : 0;
  at_target_ = within && in_window_s_ >= needed_s;
}

unsigned Axis::mode_bits() const {
  switch (mode_) {
    case Mode::ProfilePosition:
      return bit(10, at_target_) | bit(12, acknowledges_) | bit(13, following_error_);
    case Mode::ProfileVelocity: {
      const bool slow = std::abs(velocity()) <= parameters_->slow_velocity;
      return bit(10, at_target_) | bit(12, slow);
    }
    case Mode::ProfileTorque:
      return bit(10, at_target_);
    case Mode::InterpolatedPosition:
      return bit(10, standing()) | bit(12, power_.operating() && (parameters_->controlword & 0x10) != 0) |
             bit(13, following_error_);
    case Mode::Homing:
      return bit(10, (homing_.state() != Homing::State::Running || parameters_->halts()) && demand_.velocity == 0) |
             bit(12, homing_.state() == Homing::State::Attained) | bit(13, homing_.state() == Homing::State::Failed);
    case Mode::CyclicSyncPosition:
    case Mode::CyclicSyncVelocity:
    case Mode::CyclicSyncTorque:
      return bit(12, power_.operating() && !limited_) | bit(13, following_error_);
    default:
      return 0;
  }
}

void Axis::publish() {
  const double shaft_now = shaft();
  const bool in_cam = shaft_now >= parameters_->cam_from && shaft_now <= parameters_->cam_to;
  dictionary_.set(0x6041, power_.statusword() | mode_bits() | bit(11, limited_) | bit(7, overheated_));
  dictionary_.set(0x6061, static_cast<std::int64_t>(mode_));
  const double to_position = position_units(), to_velocity = velocity_units();
  dictionary_.set(0x6062, std::llround(demand_.position * to_position));
  dictionary_.set(0x6064, std::llround(position() * to_position));
  dictionary_.set(0x606B, std::llround(demand_.velocity * to_velocity));
  dictionary_.set(0x606C, std::llround(velocity() * to_velocity));
  dictionary_.set(0x6077, std::lround(plant_.motor_nm() * 1000 / mechanics_.rated_torque_nm));
  dictionary_.set(0x60F4, std::llround((demand_.position - position()) * to_position));
  dictionary_.set(0x6074, std::lround(torque_nm_ * 1000 / mechanics_.rated_torque_nm));
  dictionary_.set(0x60FD, bit(0, at_negative_limit()) | bit(1, at_positive_limit()) | bit(2, in_cam) |
                              bit(16, probes_[0].closed()) | bit(17, probes_[1].closed()));
  dictionary_.set(0x60B9, probes_[0].status() | probes_[1].status() << 8);
  dictionary_.set(0x60BA, probes_[0].at_rise());
  dictionary_.set(0x60BB, probes_[0].at_fall());
  dictionary_.set(0x60BC, probes_[1].at_rise());
  dictionary_.set(0x60BD, probes_[1].at_fall());
  constexpr std::int64_t kWarm = 250;  // tenths of a degree
  constexpr std::int64_t kHot = 1150;
  dictionary_.set(0x2001, overheated_ ? kHot : kWarm);
}

}  // namespace rmac::vdrive
