// Power, objects and steps. What an operating drive does in each mode stands in axis_modes.cpp.
#include "gateway/simulators/vdrive/axis/axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rmac::vdrive {
namespace {

constexpr double kStep_s = 125e-6;  // of the drive's own loops

constexpr std::uint16_t kFollowingError = 0x8611;
constexpr std::uint16_t kOvertemperature = 0x4310;

bool takes_torque_offset(Mode mode) {
  return mode == Mode::CyclicSyncPosition || mode == Mode::CyclicSyncVelocity;
}

unsigned bit(unsigned number, bool set) {
  return set ? 1U << number : 0U;
}

}  // namespace

Axis::Axis(Dictionary& dictionary, const fieldbus::AxisPlantParameters& plant, Report report)
    : dictionary_(dictionary),
      units_(dictionary),
      report_(std::move(report)),
      parameters_(read_parameters(dictionary, units_, plant)),
      shaft_(plant) {
  reset();
}

void Axis::reset() {
  parameters_ = read_parameters(dictionary_, units_, shaft_.mechanics());
  power_ = PowerStates();
  power_.proceed(true, parameters_.options);
  home_search_.reset();
  targets_.reset();
  watch_.reset();
  probes_.reset();
  shaft_.forget_shifts();
  mode_ = Mode::None;
  dictionary_.set(0x6076, std::llround(shaft_.mechanics().rated_torque_nm * 1000));
  dictionary_.set({0x608F, 1}, std::llround(shaft_.mechanics().encoder.counts_per_revolution));
  follow_actual();
  publish();
}

void Axis::take(ObjectAddress object) {
  parameters_ = read_parameters(dictionary_, units_, shaft_.mechanics());
  if (object.index == 0x6040) take_controlword();
  if (object.index == 0x60B8) probes_.set_function(static_cast<unsigned>(dictionary_.number(0x60B8)));
  if (object.index == 0x6060) take_mode();
  take_setpoint(object);
}

void Axis::take_setpoint(ObjectAddress object) {
  const bool cyclic = object.index == 0x607A && mode_ == Mode::CyclicSyncPosition;
  if (!cyclic && (object.index != 0x60C1 || mode_ != Mode::InterpolatedPosition)) return;
  // 60C2h: value times ten to the index, in seconds.
  const double within_s = static_cast<double>(dictionary_.number(0x60C2, 1)) *
                          std::pow(10.0, static_cast<double>(dictionary_.number(0x60C2, 2)));
  line_.take(static_cast<double>(dictionary_.number(object.index, object.sub)) / units_.of_position(), within_s);
}

void Axis::take_mode() {
  const Mode wanted = static_cast<Mode>(dictionary_.number(0x6060));
  if (wanted == mode_) return;
  mode_ = wanted;
  home_search_.reset();
  targets_.drop_next();
  targets_.stay(demand_.position);
  watch_.leave_target();
  line_.stay(demand_.position);
  profile_nm_ = torque_nm_;
}

void Axis::take_controlword() {
  const auto word = static_cast<std::uint16_t>(dictionary_.number(0x6040));
  const bool was_powered = power_.powered();
  if (power_.control(word, parameters_.options)) report_(0);
  if (!was_powered && power_.powered()) follow_actual();
  const bool changed =
      targets_.control(word, {.active = power_.operating() && mode_ == Mode::ProfilePosition,
                              .at_target = watch_.at_target(),
                              .at_rest = demand_.velocity == 0,
                              .written = static_cast<double>(dictionary_.number(0x607A)) / units_.of_position()});
  if (changed) watch_.leave_target();
}

void Axis::trip(std::uint16_t error_code) {
  if (power_.state() == PowerStates::Fault || power_.state() == PowerStates::FaultReaction) return;
  power_.raise_fault(parameters_.options);
  report_(error_code);
}

void Axis::abort_connection() {
  constexpr std::uint16_t kHeartbeatError = 0x8130;
  power_.abort_connection(static_cast<int>(dictionary_.number(0x6007)), parameters_.options);
  if (power_.state() == PowerStates::FaultReaction) dictionary_.set(0x603F, kHeartbeatError);
}

void Axis::follow_actual() {
  demand_ = {.position = shaft_.position(), .velocity = shaft_.velocity(), .acceleration = 0};
  line_.stay(demand_.position);
  targets_.stay(demand_.position);
  offset_nm_ = takes_torque_offset(mode_) ? parameters_.torque_offset : 0;
  loops_.start(shaft_.mechanics().gravity_nm - offset_nm_);
  home_search_.start_from(shaft_, parameters_.switches.index);
  torque_nm_ = 0;
}

void Axis::advance(double duration_s) {
  if (duration_s <= 0) return;
  // A host that stood still for long would otherwise be busy for as long with what it missed.
  constexpr double kMostAtOnce_s = 0.5;
  const double bounded = std::min(duration_s, kMostAtOnce_s);
  const int steps = static_cast<int>(std::ceil(bounded / kStep_s - 1e-9));
  for (int i = 0; i < steps; ++i) step(bounded / steps);
}

void Axis::step(double dt) {
  if (overheated_) trip(kOvertemperature);
  const Demand before = demand_;
  const double angle_before = shaft_.angle();
  limited_ = false;
  if (!power_.operating()) profile_nm_ = 0;
  if (power_.operating()) {
    operate(dt);
    const bool torque = mode_ == Mode::CyclicSyncTorque || mode_ == Mode::ProfileTorque || mode_ == Mode::None;
    if (!torque && mode_ != Mode::Homing) stop_at_limits(before, dt);
    // What the master sends beside: a velocity to a position, a torque to both (60B1h, 60B2h).
    Demand demand = demand_;
    if (mode_ == Mode::CyclicSyncPosition) {
      demand.velocity = parameters_.own_velocity * demand.velocity + parameters_.velocity_offset;
    }
    offset_nm_ = takes_torque_offset(mode_) ? parameters_.torque_offset : 0;
    if (!torque) torque_nm_ = loops_.torque(demand, shaft_, parameters_.most_torque, dt) + offset_nm_;
  } else if (power_.powered()) {
    // From what it does, not from what it was asked to do: a setpoint may have been out of reach.
    if (!braking_) demand_ = {.position = shaft_.position(), .velocity = shaft_.velocity(), .acceleration = 0};
    loops_.take_up(std::exchange(offset_nm_, 0));
    ramp_to_rest(power_.braking(), parameters_.deceleration, dt);
    torque_nm_ = loops_.torque(demand_, shaft_, parameters_.most_torque, dt);
  } else {
    follow_actual();
  }
  braking_ = power_.powered() && !power_.operating();
  torque_nm_ = std::clamp(torque_nm_, -parameters_.most_torque, parameters_.most_torque);
  shaft_.advance(torque_nm_, !power_.powered(), dt);
  probes_.see(shaft_, angle_before, parameters_.switches, units_.of_position());
  watch(dt);
  power_.proceed(standing(), parameters_.options);
}

void Axis::watch(double dt) {
  const double error = std::abs(demand_.position - shaft_.position());
  const bool follows = power_.operating() && (mode_ == Mode::CyclicSyncPosition || mode_ == Mode::ProfilePosition ||
                                              mode_ == Mode::InterpolatedPosition);
  constexpr double kOff = 4294967295.0;
  const bool beyond = follows && parameters_.error_window < kOff && error > parameters_.error_window;
  if (watch_.follow(beyond, parameters_.error_s, dt)) trip(kFollowingError);

  if (parameters_.halts()) return watch_.reach(standing(), 0, dt);
  switch (mode_) {
    case Mode::ProfilePosition:
      return watch_.reach(!targets_.has_next() && std::abs(targets_.target() - shaft_.position()) <= parameters_.window,
                          parameters_.window_s, dt);
    case Mode::ProfileVelocity:
      return watch_.reach(std::abs(parameters_.target_velocity - shaft_.velocity()) <= parameters_.velocity_window,
                          parameters_.velocity_window_s, dt);
    case Mode::ProfileTorque:
      return watch_.reach(profile_nm_ == parameters_.target_torque, 0, dt);
    default:
      return watch_.reach(false, 0, dt);
  }
}

unsigned Axis::mode_bits() const {
  switch (mode_) {
    case Mode::ProfilePosition:
      return bit(10, watch_.at_target()) | bit(12, targets_.acknowledges()) | bit(13, watch_.following_error());
    case Mode::ProfileVelocity: {
      const bool slow = std::abs(shaft_.velocity()) <= parameters_.slow_velocity;
      return bit(10, watch_.at_target()) | bit(12, slow);
    }
    case Mode::ProfileTorque:
      return bit(10, watch_.at_target());
    case Mode::InterpolatedPosition:
      return bit(10, standing()) | bit(12, power_.operating() && (parameters_.controlword & 0x10) != 0) |
             bit(13, watch_.following_error());
    case Mode::Homing: {
      const Homing::State search = home_search_.state();
      return bit(10, (search != Homing::State::Running || parameters_.halts()) && demand_.velocity == 0) |
             bit(12, search == Homing::State::Attained) | bit(13, search == Homing::State::Failed);
    }
    case Mode::CyclicSyncPosition:
    case Mode::CyclicSyncVelocity:
    case Mode::CyclicSyncTorque:
      return bit(12, power_.operating() && !limited_) | bit(13, watch_.following_error());
    default:
      return 0;
  }
}

void Axis::publish() {
  const double angle = shaft_.angle();
  const AxisSwitches& switches = parameters_.switches;
  const double rated_nm = shaft_.mechanics().rated_torque_nm;
  const TouchProbe& first = probes_.probe(0);
  const TouchProbe& second = probes_.probe(1);
  dictionary_.set(0x6041, power_.statusword() | mode_bits() | bit(11, limited_) | bit(7, overheated_));
  dictionary_.set(0x6061, static_cast<std::int64_t>(mode_));
  const double to_position = units_.of_position(), to_velocity = units_.of_velocity();
  dictionary_.set(0x6062, std::llround(demand_.position * to_position));
  dictionary_.set(0x6064, std::llround(shaft_.position() * to_position));
  dictionary_.set(0x606B, std::llround(demand_.velocity * to_velocity));
  dictionary_.set(0x606C, std::llround(shaft_.velocity() * to_velocity));
  dictionary_.set(0x6077, std::lround(shaft_.motor_nm() * 1000 / rated_nm));
  dictionary_.set(0x60F4, std::llround((demand_.position - shaft_.position()) * to_position));
  dictionary_.set(0x6074, std::lround(torque_nm_ * 1000 / rated_nm));
  dictionary_.set(0x60FD, bit(0, switches.at_negative_limit(angle)) | bit(1, switches.at_positive_limit(angle)) |
                              bit(2, switches.in_cam(angle)) | bit(16, first.closed()) | bit(17, second.closed()));
  dictionary_.set(0x60B9, probes_.status());
  dictionary_.set(0x60BA, first.at_rise());
  dictionary_.set(0x60BB, first.at_fall());
  dictionary_.set(0x60BC, second.at_rise());
  dictionary_.set(0x60BD, second.at_fall());
  constexpr std::int64_t kWarm = 250;  // tenths of a degree
  constexpr std::int64_t kHot = 1150;
  dictionary_.set(0x2001, overheated_ ? kHot : kWarm);
}

}  // namespace rmac::vdrive
