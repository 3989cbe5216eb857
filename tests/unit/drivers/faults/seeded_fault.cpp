#include "seeded_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rmac::fault_test {

const char* to_string(Broken broken) {
  constexpr std::array<const char*, kBrokenCount> kNames{"Nothing",     "FrozenEncoder", "ReversedSign", "Oscillation",
                                                         "BlockedAxis", "Contact",       "LostAnswers"};
  return kNames.at(static_cast<std::size_t>(broken));
}

const char* to_string(Doing doing) {
  constexpr std::array<const char*, static_cast<std::size_t>(Doing::Count)> kNames{
      "rests", "creeps", "feeds", "jogs", "reverses", "was just enabled", "brakes"};
  return kNames.at(static_cast<std::size_t>(doing));
}

SeededFault::SeededFault(const TreeMachine& machine, Broken broken, unsigned seed)
    : machine_(machine), broken_(broken), seed_(seed), random_(seed), axes_(machine.axes()), parts_(machine.parts()) {
  joint_ = random_() % parts_.joints.size();
  doing_ = static_cast<Doing>(random_() % static_cast<unsigned>(Doing::Count));
  drive_ = machine.drive_of(joint_);
  for (std::size_t j = 0; j < parts_.joints.size(); ++j) gains_.push_back(machine.device().joints[j].gains);
  draw_plant();
  draw_path();
  draw_events();
  build();
}

namespace {

/// Loops that `rmac tune` finds for DMACXYZ's X where it bends at other frequencies (docs/servo.md).
struct Tuned {
  double hz;
  std::array<double, 3> gains;
  double notch_width;  ///< 0: none
  double low_pass_hz;
};
constexpr std::array<Tuned, 3> kTuned{
    {{212, {253, 9437, 5.4}, 0.7, 180}, {346, {414, 19805, 6.9}, 0, 180}, {600, {733, 44912, 8.6}, 0, 350}}};
constexpr double kTunedMass = 34.9e-3;

}  // namespace

/// A stiffness that has it bend at another frequency, and the loop that belongs to it.
void SeededFault::give_resonance(fieldbus::AxisPlantParameters& plant, ServoJoint& joint) {
  const double aside = uniform(0.92, 1.08);
  plant.stiffness_nm_rad *= aside * aside;
  const bool desk_mill = drive_.max_effort == 800;
  const auto choice = random_() % (kTuned.size() + 1);
  if (!desk_mill || choice == kTuned.size()) return;
  const Tuned& tuned = kTuned.at(choice);
  const double natural = 2 * std::numbers::pi * tuned.hz * aside;
  const double whole = plant.inertia_kg_m2(), load = plant.load_inertia_kg_m2;
  plant.stiffness_nm_rad = natural * natural * (whole - load) * load / whole;
  const double mass = whole / (drive_.mm_per_rad * drive_.nm_per_effort);
  for (std::size_t i = 0; i < tuned.gains.size(); ++i) gains_[joint_][i] = tuned.gains.at(i) * mass / kTunedMass;
  joint.mechanics.resonances.clear();
  if (tuned.notch_width > 0) joint.mechanics.resonances = {{tuned.hz, 0.05, tuned.notch_width}};
  joint.mechanics.low_pass_hz = tuned.low_pass_hz;
}

/// Half to twice the mass, and a loop as large; another stiffness; a weight that was not weighed well.
void SeededFault::draw_plant() {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (auto* const plant = std::get_if<fieldbus::AxisPlantParameters>(&axes_[i]))
      plant->encoder.seed = 100 * seed_ + i;
  }
  auto& plant = std::get<fieldbus::AxisPlantParameters>(axes_[drive_.axis]);
  give_resonance(plant, parts_.joints[joint_]);
  mass_factor_ = log_uniform(0.5, 2);
  for (double* const part : {&plant.rotor_inertia_kg_m2, &plant.screw_inertia_kg_m2, &plant.table_mass_kg,
                             &plant.load_inertia_kg_m2, &plant.stiffness_nm_rad}) {
    *part *= mass_factor_;
  }
  for (const std::size_t gain : {0U, 1U, 2U, 4U}) {  // Kp, Ki, Kd, and Ka of the laws that have it
    if (gain < gains_[joint_].size()) gains_[joint_][gain] *= mass_factor_;
  }
  plant.gravity_nm *= uniform(0.8, 1.2);
  tells_torque_ = chance(0.5);
}

void SeededFault::draw_path() {
  const auto& limits = machine_.device().joints[joint_].limits;
  const bool linear = limits.type == JointType::Linear;
  const double creep = 1.0 / 60;
  const double feed =
      std::min(linear ? machine_.device().max_feedrate_mm_min / 60 : 0.3 * limits.max_speed, 0.8 * limits.max_speed);
  const double acceleration = 0.9 * limits.max_acceleration;
  const double any = log_uniform(creep, feed);
  // A contact stops a motor that turns to smaller angles.
  const double sign = broken_ == Broken::Contact || chance(0.5) ? -1 : 1;
  const auto go = [&](double speed, double from, double until = 1e6) {
    return JointPath::go(sign * speed, acceleration, from, until);
  };
  break_at_ = static_cast<int>(uniform(50, 400));
  const double break_s = break_at_ * 1e-3, begin = uniform(0.02, 0.05);
  switch (doing_) {
    case Doing::Rests:
      paths_[0] = go(any, break_s + uniform(0.05, 0.3));
      break;
    case Doing::Creeps:
      paths_[0] = go(creep, begin);
      break;
    case Doing::Feeds:
      paths_[0] = go(feed, begin);
      break;
    case Doing::Jogs:
      paths_[0] = go(uniform(0.3, 1) * limits.max_speed, begin);
      break;
    case Doing::Reverses: {
      const double amplitude = log_uniform(0.2, 10);
      paths_[0] =
          JointPath::swing(amplitude, std::min(std::sqrt(0.3 * acceleration / amplitude), feed / amplitude), begin);
      break;
    }
    case Doing::WasJustEnabled:
      break_at_ = static_cast<int>(uniform(0, 20));
      paths_[0] = go(any, begin);
      break;
    case Doing::Brakes:
      paths_[0] = go(feed, begin, break_s - uniform(0, 0.05));
      paths_[1] = go(any, break_s + uniform(0.1, 0.3));
      break;
    case Doing::Count:
      break;
  }
}

void SeededFault::draw_events() {
  gain_factor_ = log_uniform(2, 8);
  const double most_nm = drive_.max_effort * drive_.nm_per_effort;
  // What a cutter that enters material may ask of a loop: less than what brings it to its bound.
  const double bound_nm = 0.25 * gains_[joint_][0] * drive_.max_following_error * drive_.nm_per_effort;
  if (chance(0.5)) {
    pushed_at_ = static_cast<int>(uniform(20, 500));
    push_nm_ = std::min(0.4 * most_nm, bound_nm) * uniform(-1, 1);
    push_rise_s_ = log_uniform(0.001, 0.2);
  }
  if (chance(0.3) && broken_ != Broken::Oscillation) {
    teeth_nm_ = std::min(0.075 * most_nm, bound_nm) * uniform(0, 1);
    teeth_hz_ = uniform(10, 310);
  }
  if (chance(0.3)) miss_share_ = 0.01;
  // A bound of 50 µm is for drives that are never late (docs/servo.md).
  if (chance(0.3) && machine_.device().joints[joint_].max_jump == 0) repeat_share_ = 0.003;
  if (chance(0.3)) late_share_ = 0.003;
}

void SeededFault::build() {
  simulated_ = std::make_shared<fieldbus::SimulatedInterface>(axes_, 0.001);
  simulated_->set_answer_delay(machine_.answer_delay());
  bus_ = std::make_shared<FaultyBus>(simulated_, tells_torque_);
  const auto words = std::make_shared<ServoBus>(bus_);
  const auto& limits = machine_.device().joints[joint_].limits;
  const bool limited = limits.limit_type == JointLimitType::Limited;
  simulated_->plant(drive_.axis)
      .put_at(uniform(limited ? limits.min : -180, limited ? limits.max : 180) / drive_.mm_per_rad);
  for (ServoActuator& actuator : parts_.actuators) actuator.bus = words;
  for (ServoSpindle& spindle : parts_.spindles) spindle.bus = words;
  for (std::size_t j = 0; j < parts_.joints.size(); ++j) {
    if (parts_.joints[j].force_sensor) parts_.joints[j].force_sensor->bus = words;
    static_cast<void>(parts_.joints[j].law->set_gains(gains_[j]));
  }
  parts_.max_cycles_lost = 5;
  if (broken_ == Broken::ReversedSign) {
    is_broken_ = true;
    chance(0.5) ? bus_->reverse_motor(drive_.axis) : bus_->reverse_encoder(drive_.axis);
  }
  truth_ = TrueJoint(drive_, simulated_->plant(drive_.axis));
  auto made = ServoLoop::create(parts_);
  if (!made) throw std::runtime_error(made.error().message);
  loop_ = std::move(*made);
}

}  // namespace rmac::fault_test
