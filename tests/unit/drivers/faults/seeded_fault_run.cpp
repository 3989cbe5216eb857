#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "seeded_fault.hpp"

namespace rmac::fault_test {

using Kind = ServoFault::Kind;

void SeededFault::plan() {
  if (!report_.follows) {
    const std::span<const double> hold = loop_->hold_position();
    std::copy(hold.begin(), hold.end(), command_.setpoint.position.begin());
    std::copy(hold.begin(), hold.end(), start_.begin());
    return;
  }
  const double s = ++cycles_ * 1e-3;
  command_.setpoint.position[joint_] = start_[joint_];
  command_.setpoint.velocity[joint_] = command_.setpoint.acceleration[joint_] = 0;
  for (const JointPath& path : paths_) {
    const JointPath::Point point = path.at(s);
    command_.setpoint.position[joint_] += point.position;
    command_.setpoint.velocity[joint_] += point.velocity;
    command_.setpoint.acceleration[joint_] += point.acceleration;
  }
}

/// What a machine has to bear.
void SeededFault::disturb() {
  command_.cycles_missed = 0;
  if (!report_.follows) return;
  const double since = (cycles_ - pushed_at_) * 1e-3;
  const double push = pushed_at_ >= 0 && since > 0 ? push_nm_ * std::min(1.0, since / push_rise_s_) : 0;
  const double teeth = teeth_nm_ * std::max(0.0, std::sin(2 * std::numbers::pi * teeth_hz_ * cycles_ * 1e-3));
  simulated_->push(drive_.axis, push + teeth);
  disturb_words();
}

/// Now and then, and one thing at a time: more of them are faults.
void SeededFault::disturb_words() {
  constexpr int kNowAndThen = 100;
  const bool misses = chance(miss_share_), repeats = chance(repeat_share_), late = chance(late_share_);
  if (cycles_ < rests_until_ || !(misses || repeats || late)) return;
  rests_until_ = cycles_ + kNowAndThen * (late ? 3 : 1);
  if (late) {
    bus_->come_late();
    command_.cycles_missed = 1;
  } else {
    misses ? bus_->miss_an_answer(drive_.axis) : bus_->repeat_an_answer(drive_.axis);
  }
}

void SeededFault::break_it() {
  if (is_broken_ || broken_ == Broken::Nothing || cycles_ < break_at_ || !report_.follows) return;
  is_broken_ = true;
  fieldbus::AxisPlant& plant = simulated_->plant(drive_.axis);
  // What the joint meets gives way by 0.01 to 0.1 mm or degrees under all that its motor can do.
  const double most_nm = drive_.max_effort * drive_.nm_per_effort;
  fieldbus::PlantContact met{.stiffness_nm_rad = most_nm / (log_uniform(0.01, 0.1) / drive_.mm_per_rad),
                             .surface_rad = plant.load_rad()};
  truth_.met_stiffness_nm_rad = met.stiffness_nm_rad;
  met.damping_nm_s_rad = 0.2 * std::sqrt(met.stiffness_nm_rad * plant.parameters().inertia_kg_m2());
  switch (broken_) {
    case Broken::FrozenEncoder:
      return simulated_->freeze_encoder(drive_.axis, true);
    case Broken::Oscillation: {
      std::vector<double> stiff = gains_[joint_];
      for (std::size_t i = 0; i < 3; ++i) stiff[i] *= gain_factor_;
      static_cast<void>(parts_.joints[joint_].law->set_gains(stiff));
      return;
    }
    case Broken::BlockedAxis:
      met.clamps = true;
      return plant.touch(met);
    case Broken::Contact:
      met.surface_rad -= uniform(0.001, 0.5) / drive_.mm_per_rad;
      return plant.touch(met);
    case Broken::LostAnswers:
      return bus_->silence(drive_.axis);
    default:
      return;
  }
}

void SeededFault::cycle() {
  command_.power = ++all_cycles_ > kLoadedBefore;
  plan();
  disturb();
  break_it();
  if (const auto& sensor = parts_.joints[joint_].force_sensor; sensor && broken_ == Broken::Contact)
    bus_->feel(sensor->axis, -truth_.contact(), sensor->newton_per_count);
  loop_->cycle(command_, report_);
  const double set = loop_->hold_position()[joint_];
  if (report_.follows || std::abs(truth_.effort_share()) > 1e-3)
    truth_.look(report_.follows ? command_.setpoint.position[joint_] : set, command_.setpoint.acceleration[joint_],
                is_broken_);
}

/// The bound of its kind is over.
bool SeededFault::overdue() const {
  constexpr int kMinMs = 20, kDecides = 3;
  constexpr double kWay = 1.1;  // 1 mm from where it stands: what blocks it gives way
  const int late = machine_.answer_delay() + kDecides;
  switch (broken_) {
    case Broken::FrozenEncoder:
    case Broken::BlockedAxis:
      return truth_.since_commanded > kMinMs + late && truth_.commanded > kWay;
    case Broken::Contact:
      return truth_.since_contact > kMinMs + late && truth_.commanded > kWay;
    case Broken::ReversedSign:
      return truth_.since_effort > 10 + machine_.answer_delay();
    case Broken::Oscillation:
      return truth_.still_swings() &&
             truth_.since_swing > std::max(50.0, (truth_.path_speeds_up() ? 5 : 3) * truth_.period_ms()) + 10;
    case Broken::LostAnswers:
      return truth_.since_break > 2 + machine_.answer_delay();
    default:
      return false;
  }
}

/// By what was broken, and by nothing that the appliance says.
bool SeededFault::named_rightly() const {
  const ServoFault& fault = report_.fault;
  const bool of_joint = fault.part == ServoFault::Part::Joint && fault.index == joint_;
  // A loop that holds a joint which is free may swing against what holds it.
  const bool swings = fault.kind == Kind::Oscillation && truth_.chain >= 5;
  switch (broken_) {
    case Broken::FrozenEncoder:
      return of_joint && fault.kind == Kind::EncoderFrozen;
    case Broken::ReversedSign:
      return of_joint && fault.kind == Kind::WrongDirection;
    case Broken::Oscillation:
      return of_joint && fault.kind == Kind::Oscillation && truth_.chain >= 5;
    case Broken::BlockedAxis:
      return of_joint && (fault.kind == Kind::StandsStill || swings);
    case Broken::Contact: {
      const ServoJoint& joint = parts_.joints[joint_];
      const bool felt = joint.force_sensor && truth_.most_contact > joint.force.max_force;
      return of_joint && truth_.since_contact > 0 &&
             (fault.kind == (felt ? Kind::ForceLimit : Kind::StandsStill) || swings);
    }
    case Broken::LostAnswers:
      return fault.kind == Kind::DriveOffline && fault.part == ServoFault::Part::Actuator && fault.index == joint_;
    default:
      return false;
  }
}

void SeededFault::judge_stop(Outcome& outcome) {
  constexpr int kStopCycles = 400;
  const double at = truth_.position(), allowed = truth_.way_to_stop();
  for (int i = 0; i < kStopCycles; ++i) {
    bus_->feel(drive_.axis, 0, 1);
    simulated_->push(drive_.axis, 0);
    command_.cycles_missed = 0;
    loop_->cycle(command_, report_);
    outcome.gone_further = std::max(outcome.gone_further, std::abs(truth_.position() - at));
  }
  outcome.held = outcome.gone_further <= allowed;
  outcome.told += fmt::format("; went {:.3g} on, {:.3g} allowed", outcome.gone_further, allowed);
}

void SeededFault::judge(Outcome& outcome) {
  const bool noticed = report_.fault.kind != Kind::None;
  outcome.fault = report_.fault;
  const bool may_not = broken_ == Broken::Oscillation || (!noticed && outcome.in_time && truth_.commanded < 1) ||
                       (broken_ == Broken::Contact && truth_.since_contact == 0);
  outcome.happened = broken_ != Broken::Nothing && (noticed || !outcome.in_time || !may_not);
  outcome.right_cause = noticed ? named_rightly() : !outcome.happened;
  outcome.gone = truth_.astray;
  outcome.commanded = truth_.commanded;
  const int since = broken_ == Broken::ReversedSign  ? truth_.since_effort
                    : broken_ == Broken::Contact     ? truth_.since_contact
                    : broken_ == Broken::Oscillation ? truth_.since_swing
                    : broken_ == Broken::LostAnswers ? truth_.since_break
                                                     : truth_.since_commanded;
  outcome.noticed_after_ms = since;
  outcome.told = fmt::format(
      "seed {}, {}: {} joint {} ({:.2g} of its mass, {}) {}, broken at {} of {} ms; {} of joint {} "
      "({:.4g}, {:.4g}) after {} ms ({} turns, {:.3g} ms), true effort {:.2f}, commanded {:.4g}, astray by {:.4g}{}",
      seed_, machine_.folder(), to_string(broken_), joint_, mass_factor_,
      tells_torque_ ? "torque told" : "no torque told", to_string(doing_), break_at_, cycles_,
      rmac::to_string(report_.fault.kind), report_.fault.index, report_.fault.value, report_.fault.bound, since,
      truth_.turns, truth_.period_ms(), truth_.effort_share(), truth_.commanded, truth_.astray,
      outcome.in_time ? "" : ": too late");
  outcome.told +=
      fmt::format("; push {:.3g} at {}, teeth {:.2g} at {:.3g} Hz, missed {}, repeated {}, late {}, gains {:.2g}",
                  push_nm_, pushed_at_, teeth_nm_, teeth_hz_, miss_share_, repeat_share_, late_share_, gain_factor_);
}

Outcome SeededFault::run() {
  constexpr int kEnable = 300, kMostCycles = 20'000, kUnbroken = 800, kMostLate = 200;
  int too_late = 0;
  Outcome outcome;
  const int most = broken_ == Broken::Nothing || broken_ == Broken::Oscillation ? kUnbroken : kMostCycles;
  int cycles = 0;
  while (report_.fault.kind == Kind::None && cycles++ < kEnable + most) {
    cycle();
    if (report_.fault.kind == Kind::None && overdue()) outcome.in_time = false;
    if (!outcome.in_time && ++too_late > kMostLate) break;
    if (broken_ == Broken::Contact && truth_.since_contact == 0 && truth_.since_break > kUnbroken) break;
  }
  const bool broke = broken_ != Broken::Nothing && broken_ != Broken::Oscillation &&
                     (broken_ != Broken::Contact || truth_.since_contact > 0);
  // Slow ones are not over yet.
  if (broke && overdue() && report_.fault.kind == Kind::None) outcome.in_time = false;
  judge(outcome);
  if (outcome.happened && report_.fault.kind != Kind::None) judge_stop(outcome);
  return outcome;
}

}  // namespace rmac::fault_test
