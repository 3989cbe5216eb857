#include "gateway/dynamics/axis_dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "gateway/dynamics/axis_models.hpp"
#include "gateway/dynamics/least_jerk_way.hpp"
#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/servo/pitch_error.hpp"

namespace rmac::gateway {
namespace {

constexpr double kMetresPerMm = 1e-3;
/// Of a joint's limits, on the way to where the motion begins.
constexpr double kShare = 0.5;
constexpr double kStands_mm = 1e-9;  ///< in a cycle
constexpr double kLeastApproach_s = 0.1, kSettling_s = 0.5;

}  // namespace

void AxisDynamics::Mean::add(double t_s, double value) noexcept {
  if (std::abs(value) > peak) peak = std::abs(value), peak_t_s = t_s;
  sum2 += value * value;
}

Expected<std::unique_ptr<AxisDynamics>> AxisDynamics::open(const sdk::DeviceObject& device, const ModuleLoader& loader,
                                                           double period_s) {
  sdk::DeviceObject on_models = device;
  if (const std::string bus = put_on_models(on_models); !bus.empty()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("what its axes do is not known: bus {0} is not a simulated one, and device.json has no "
                               "model of its axes ({0}.model.interface; docs/simulated-bus.md)",
                               bus));
  }
  auto loops = ClosedLoops::assemble(on_models, {.period_s = period_s}, loader);
  if (!loops) return tl::unexpected(loops.error());
  std::vector<Motor> motors;
  for (const ServoActuator& actuator : (*loops)->mechanism().loop->parts().actuators) {
    auto* const bus = dynamic_cast<fieldbus::SimulatedInterface*>(actuator.bus->interface.get());
    if (bus == nullptr) return failure(MinorCode::Other, "a model of its axes is no simulated bus");
    motors.push_back({bus, actuator.axis});
  }
  if (const auto up = (*loops)->power_up(); !up) {
    return failure(MinorCode::Other, "on the models of its axes: " + up.error().message);
  }
  return std::unique_ptr<AxisDynamics>(new AxisDynamics(std::move(*loops), std::move(motors), device));
}

AxisDynamics::AxisDynamics(std::unique_ptr<ClosedLoops> loops, std::vector<Motor> motors,
                           const sdk::DeviceObject& device)
    : loops_(std::move(loops)),
      motors_(std::move(motors)),
      device_(device),
      joints_(device.joints.size()),
      torques_(motors_.size()),
      deviation_(device.positioning_tolerance_mm) {
  find_plays();
  see_truth(loads());
}

/// A joint is a motor's where the shaft moves it.
void AxisDynamics::find_plays() {
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  const std::array<double, kMaxJoints> there = loads();
  const auto joints_at = [&](const std::array<double, kMaxJoints>& shafts) {
    std::array<double, kMaxJoints> joints{};
    parts.actuator_map->joint_positions(std::span(shafts).first(motors_.size()),
                                        std::span(joints).first(parts.joints.size()));
    return joints;
  };
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    if (!motors_[i].bus->plant(motors_[i].axis).has_play()) continue;
    auto turned = there;
    turned[i] += 1;
    const auto before = joints_at(there), after = joints_at(turned);
    for (std::size_t j = 0; j < parts.joints.size(); ++j) plays_[j] = plays_[j] || before[j] != after[j];
  }
}

std::span<const double> AxisDynamics::joints() const noexcept {
  return std::span(truth_).first(device_.joints.size());
}

void AxisDynamics::cycle(const CycleSample& planned, const Beside& beside) {
  if (stopped_) return;
  if (!std::exchange(begun_, true)) approach(planned);
  if (stopped_) return;
  push(beside);
  Setpoint& setpoint = loops_->command.setpoint;
  setpoint.position = planned.position_set;
  setpoint.velocity = planned.velocity_set;
  setpoint.acceleration = planned.acceleration_set;
  setpoint.pose = planned.pose_set;
  setpoint.move_id = planned.move_id;
  setpoint.moving = planned.moving;
  run(planned, beside.line);
  account(planned, beside);
}

void AxisDynamics::run(const CycleSample& planned, int line) {
  // Drives measure as a cycle begins, and tell late or soon: where the loads are then is the cycle's.
  const std::array<double, kMaxJoints> now = loads();
  const bool sound = loops_->cycle();
  see_truth(now);
  if (sound) return;
  stopped_ = {.line = line, .move_id = planned.move_id, .t_s = planned.t_s, .why = loops_->fault_text()};
}

void AxisDynamics::approach(const CycleSample& planned) {
  Setpoint& setpoint = loops_->command.setpoint;
  const std::array<double, kMaxJoints> from = setpoint.position;
  double time_s = kLeastApproach_s;
  for (std::size_t j = 0; j < device_.joints.size(); ++j) {
    const double length = std::abs(planned.position_set[j] - from[j]);
    time_s = std::max(time_s, LeastJerkWay::least_time_s(device_.joints[j].limits, length, kShare));
  }
  const double period_s = loops_->mechanism().planner_model.period_s;
  const auto cycles = static_cast<int>(std::ceil((time_s + kSettling_s) / period_s));
  for (int i = 1; i <= cycles; ++i) {
    for (std::size_t j = 0; j < device_.joints.size(); ++j) {
      const LeastJerkWay way{from[j], planned.position_set[j] - from[j], time_s};
      std::tie(setpoint.position[j], setpoint.velocity[j], setpoint.acceleration[j]) =
          std::tuple_cat(way.at(i * period_s));
    }
    run(planned, 0);
    if (stopped_) return;
  }
}

/// Power is conserved: what a joint feels is the force along the way that the tip goes with it, and what a shaft feels
/// is what its joints do.
std::array<double, kMaxJoints> AxisDynamics::torques_of(const Eigen::Vector3d& force_n, const Frame& tool) const {
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  const std::size_t count = device_.joints.size();
  std::array<double, 6 * kMaxJoints> jacobian{};
  kinematics().jacobian(joints(), tool, std::span(jacobian).first(6 * count));
  std::array<double, kMaxJoints> efforts{}, torques{};
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t row = 0; row < 3; ++row) {
      efforts[j] += jacobian[row * count + j] * force_n[static_cast<Eigen::Index>(row)];
    }
    // mm a degree to m a radian.
    if (device_.joints[j].limits.type == JointType::Rotary) efforts[j] *= kMetresPerMm * 180 / std::numbers::pi;
  }
  parts.actuator_map->actuator_efforts(std::span(truth_).first(parts.joints.size()),
                                       std::span(efforts).first(parts.joints.size()),
                                       std::span(torques).first(parts.actuators.size()));
  for (std::size_t i = 0; i < motors_.size(); ++i) torques[i] *= parts.actuators[i].scale.direction;
  return torques;
}

void AxisDynamics::push(const Beside& beside) {
  const bool pushes = !beside.force_n.isZero();
  if (!pushes && !std::exchange(pushed_, false)) return;
  pushed_ = pushes;
  const auto torques = torques_of(beside.force_n, beside.tool);
  for (std::size_t i = 0; i < motors_.size(); ++i) motors_[i].bus->push(motors_[i].axis, torques[i]);
}

std::vector<VibrationMode> AxisDynamics::modes(const Frame& tool) const {
  std::array<std::array<double, kMaxJoints>, 3> by_unit{};
  const auto gives_way = [&](const Motor& motor) { return motor.bus->plant(motor.axis).parameters().gives_way(); };
  if (std::ranges::none_of(motors_, gives_way)) return {};
  for (Eigen::Index i = 0; i < 3; ++i)
    by_unit[static_cast<std::size_t>(i)] = torques_of(Eigen::Vector3d::Unit(i), tool);
  std::vector<VibrationMode> modes;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    if (!gives_way(motors_[i])) continue;
    // N·m a newton: the way in metres that the tip goes for each radian of the load.
    const Eigen::Vector3d way(by_unit[0][i], by_unit[1][i], by_unit[2][i]);
    if (way.isZero()) continue;
    const fieldbus::AxisPlantParameters& plant = motors_[i].bus->plant(motors_[i].axis).parameters();
    const fieldbus::TwoMassParameters masses = plant.two_masses();
    // Of the free oscillation, seen at the load: the motor takes its share of it.
    const double share = (masses.motor_inertia_kg_m2 + masses.load_inertia_kg_m2) / masses.motor_inertia_kg_m2;
    const double stiffness_n_m = masses.stiffness_nm_rad * share * share / way.squaredNorm();
    modes.push_back({.frequency_hz = masses.resonance_rad_s() / (2 * std::numbers::pi),
                     .damping_ratio = plant.damping_ratio,
                     .stiffness_n_mm = stiffness_n_m * kMetresPerMm,
                     .directions = way.normalized() * way.normalized().transpose()});
  }
  return modes;
}

std::array<double, kMaxJoints> AxisDynamics::loads() const {
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  std::array<double, kMaxJoints> angles{};
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const DriveScale& scale = parts.actuators[i].scale;
    const double turns = motors_[i].bus->plant(motors_[i].axis).load_rad() / (2 * std::numbers::pi);
    angles[i] = shaft_rad(scale, turns * scale.counts_per_revolution);
  }
  return angles;
}

/// What a joint's mechanics do wrong is what the loop makes good of where its drives are.
void AxisDynamics::see_truth(const std::array<double, kMaxJoints>& loads) {
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  const std::size_t count = parts.joints.size();
  std::array<double, kMaxJoints> told{}, by_told{};
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const ServoActuator& actuator = parts.actuators[i];
    told[i] = shaft_rad(actuator.scale, actuator.bus->feedback[actuator.axis].position_counts);
  }
  const auto joints_of = [&](std::span<const double> shafts, std::span<double> joints) {
    parts.actuator_map->joint_positions(shafts.first(motors_.size()), joints.first(count));
  };
  joints_of(told, by_told);
  joints_of(loads, truth_);
  for (std::size_t j = 0; j < count; ++j) {
    truth_[j] +=
        plays_[j] ? pitch_error(parts.joints[j].mechanics.pitch, truth_[j]) : loops_->report().position[j] - by_told[j];
  }
}

Eigen::Vector3d AxisDynamics::tip(std::span<const double> joints, const Frame& tool) const {
  ToolPose pose;
  kinematics().forward(joints, tool, pose);
  return {pose.tip[0], pose.tip[1], pose.tip[2]};
}

void AxisDynamics::account(const CycleSample& planned, const Beside& beside) {
  moved_ = moved_ || planned.moving;
  if (!moved_) return;
  ++count_;
  for (std::size_t j = 0; j < joints_.size(); ++j) joints_[j].add(planned.t_s, truth_[j] - planned.position_set[j]);
  for (std::size_t i = 0; i < torques_.size(); ++i) torques_[i].add(planned.t_s, torque_nm(i));
  if (!planned.moving) return;
  const std::span wanted = std::span(planned.position_set).first(device_.joints.size());
  const Vector& place = planned.pose_set.tip;
  const Eigen::Vector3d there = tip(wanted, beside.tool);
  deviation_.add({.planned = there,
                  .truth = tip(joints(), beside.tool) + beside_way(beside.bend_mm, there),
                  .place = {place[0], place[1], place[2]},
                  .t_s = planned.t_s,
                  .line = beside.line,
                  .move_id = planned.move_id});
}

double AxisDynamics::torque_nm(std::size_t motor) const {
  return shaft_nm(loops_->mechanism().loop->parts().actuators[motor].scale, loops_->report().torque_permille[motor]);
}

Eigen::Vector3d AxisDynamics::beside_way(const Eigen::Vector3d& bend_mm, const Eigen::Vector3d& planned) {
  if (way_.last && (planned - *way_.last).norm() > kStands_mm) way_.along = (planned - *way_.last).normalized();
  way_.last = planned;
  return bend_mm - bend_mm.dot(way_.along) * way_.along;
}

void AxisDynamics::finish() {
  deviation_.forget();
}

std::vector<JointDeviation> AxisDynamics::joint_deviations() const {
  std::vector<JointDeviation> told;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    told.push_back({.name = device_.joints[j].limits.name,
                    .rotary = device_.joints[j].limits.type == JointType::Rotary,
                    .peak = joints_[j].peak,
                    .rms = std::sqrt(joints_[j].sum2 / static_cast<double>(std::max<std::size_t>(count_, 1)))});
  }
  return told;
}

std::vector<MotorTorque> AxisDynamics::motor_torques() const {
  std::vector<MotorTorque> told;
  for (std::size_t i = 0; i < torques_.size(); ++i) {
    const sdk::Actuator& actuator = device_.actuators[i];
    const double bound_nm = loops_->mechanism().loop->parts().actuators[i].max_torque_nm;
    told.push_back({.bus = actuator.bus,
                    .axis = actuator.axis,
                    .rated_nm = actuator.scale.rated_torque_nm,
                    .peak_nm = torques_[i].peak,
                    .rms_nm = std::sqrt(torques_[i].sum2 / static_cast<double>(std::max<std::size_t>(count_, 1))),
                    .peak_t_s = torques_[i].peak_t_s,
                    .allowed_nm = bound_nm});
  }
  return told;
}

}  // namespace rmac::gateway
