#include "gateway/dynamics/axis_dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gateway/dynamics/axis_models.hpp"
#include "rmac/motion/drive_scale.hpp"

namespace rmac::gateway {
namespace {

constexpr double kMetresPerMm = 1e-3;
/// Of a joint's limits, on the way to where the motion begins.
constexpr double kShare = 0.5;
constexpr double kLeastApproach_s = 0.1, kSettling_s = 0.5;

/// How long a joint takes for a way by the polynomial of least jerk, whose peaks are 1.875, 5.774 and 60.
double approach_s(const JointLimits& limits, double length) {
  return std::max({1.875 * length / (kShare * limits.max_speed),
                   std::sqrt(5.774 * length / (kShare * limits.max_acceleration)),
                   std::cbrt(60 * length / (kShare * limits.max_jerk))});
}

}  // namespace

void AxisDynamics::Mean::add(double value) noexcept {
  peak = std::max(peak, std::abs(value));
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
  see_truth();
}

std::span<const double> AxisDynamics::joints() const noexcept {
  return std::span(truth_).first(device_.joints.size());
}

std::span<const double> AxisDynamics::measured() const noexcept {
  return std::span(loops_->report().position).first(device_.joints.size());
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
  if (!run(planned, beside.line)) return;
  account(planned, beside);
}

bool AxisDynamics::run(const CycleSample& planned, int line) {
  const bool sound = loops_->cycle();
  see_truth();
  if (!sound) {
    stopped_ = {.line = line, .move_id = planned.move_id, .t_s = planned.t_s, .why = loops_->fault_text()};
  }
  return sound;
}

void AxisDynamics::approach(const CycleSample& planned) {
  Setpoint& setpoint = loops_->command.setpoint;
  const std::array<double, kMaxJoints> from = setpoint.position;
  double time_s = kLeastApproach_s;
  for (std::size_t j = 0; j < device_.joints.size(); ++j) {
    time_s = std::max(time_s, approach_s(device_.joints[j].limits, std::abs(planned.position_set[j] - from[j])));
  }
  const double period_s = loops_->mechanism().planner_model.period_s;
  const auto cycles = static_cast<int>(std::ceil((time_s + kSettling_s) / period_s));
  for (int i = 1; i <= cycles; ++i) {
    const double u = std::min(1.0, i * period_s / time_s);
    for (std::size_t j = 0; j < device_.joints.size(); ++j) {
      const double way = planned.position_set[j] - from[j];
      setpoint.position[j] = from[j] + way * u * u * u * (10 + u * (-15 + 6 * u));
      setpoint.velocity[j] = way * u * u * (30 + u * (-60 + 30 * u)) / time_s;
      setpoint.acceleration[j] = way * u * (60 + u * (-180 + 120 * u)) / (time_s * time_s);
    }
    if (!run(planned, 0)) return;
  }
}

/// Power is conserved: what a joint feels is the force along the way that the tip goes with it, and what a shaft feels
/// is what its joints do.
void AxisDynamics::push(const Beside& beside) {
  const bool pushes = !beside.force_n.isZero();
  if (!pushes && !std::exchange(pushed_, false)) return;
  pushed_ = pushes;
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  const std::size_t count = device_.joints.size();
  std::array<double, 6 * kMaxJoints> jacobian{};
  kinematics().jacobian(joints(), beside.tool, std::span(jacobian).first(6 * count));
  std::array<double, kMaxJoints> efforts{}, torques{};
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t row = 0; row < 3; ++row) {
      efforts[j] += jacobian[row * count + j] * beside.force_n[static_cast<Eigen::Index>(row)];
    }
    // mm a degree to m a radian.
    if (device_.joints[j].limits.type == JointType::Rotary) efforts[j] *= kMetresPerMm * 180 / std::numbers::pi;
  }
  parts.actuator_map->actuator_efforts(std::span(truth_).first(parts.joints.size()),
                                       std::span(efforts).first(parts.joints.size()),
                                       std::span(torques).first(parts.actuators.size()));
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    motors_[i].bus->push(motors_[i].axis, parts.actuators[i].scale.direction * torques[i]);
  }
}

/// A joint is as far from where its motor's encoder has it as the map makes of the shaft's difference.
void AxisDynamics::see_truth() {
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  const std::size_t count = parts.joints.size();
  std::array<double, kMaxJoints> told{}, loads{}, by_told{}, by_loads{};
  for (std::size_t i = 0; i < parts.actuators.size(); ++i) {
    const ServoActuator& actuator = parts.actuators[i];
    const DriveFeedback& words = actuator.bus->feedback[actuator.axis];
    told[i] = shaft_rad(actuator.scale, words.position_counts);
    loads[i] = shaft_rad(actuator.scale, words.load_counts);
  }
  parts.actuator_map->joint_positions(std::span(told).first(parts.actuators.size()), std::span(by_told).first(count));
  parts.actuator_map->joint_positions(std::span(loads).first(parts.actuators.size()), std::span(by_loads).first(count));
  for (std::size_t j = 0; j < count; ++j) truth_[j] = loops_->report().position[j] + by_loads[j] - by_told[j];
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
  for (std::size_t j = 0; j < joints_.size(); ++j) joints_[j].add(truth_[j] - planned.position_set[j]);
  const ServoLoopParts& parts = loops_->mechanism().loop->parts();
  for (std::size_t i = 0; i < torques_.size(); ++i) {
    torques_[i].add(shaft_nm(parts.actuators[i].scale, loops_->report().torque_permille[i]));
  }
  if (!planned.moving) return;
  const std::span wanted = std::span(planned.position_set).first(device_.joints.size());
  const Vector& place = planned.pose_set.tip;
  deviation_.add({.planned = tip(wanted, beside.tool),
                  .truth = tip(joints(), beside.tool),
                  .place = {place[0], place[1], place[2]},
                  .t_s = planned.t_s,
                  .line = beside.line,
                  .move_id = planned.move_id});
}

void AxisDynamics::finish() {
  deviation_.forget();
}

std::vector<JointDeviation> AxisDynamics::joint_deviations() const {
  std::vector<JointDeviation> told;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    told.push_back({.name = device_.joints[j].limits.name,
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
                    .allowed_nm = bound_nm});
  }
  return told;
}

}  // namespace rmac::gateway
