#pragma once

#include <array>
#include <memory>

#include "gateway/verifier/watch.hpp"
#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/ports/servo_law.hpp"

// The ports of a module under check: each call is noted before it is passed on, and trapped where it is one of the
// cycle.

namespace rmac::verifier {

class WatchedKinematics final : public Kinematics {
 public:
  WatchedKinematics(std::shared_ptr<const Kinematics> kinematics, Watch& watch)
      : kinematics_(std::move(kinematics)), watch_(watch) {}
  std::size_t joint_count() const noexcept override { return kinematics_->joint_count(); }
  JointType joint_type(std::size_t joint) const noexcept override { return kinematics_->joint_type(joint); }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    watch_.stateless("forward", {{"joints", joints}, {"tool", numbers(tool)}}, {},
                     [&](std::span<double>) { kinematics_->forward(joints, tool, pose); });
  }
  KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                           std::span<double> joints) const noexcept override {
    return watch_.stateless("inverse", {{"pose", numbers(pose)}, {"tool", numbers(tool)}, {"seed", seed}}, joints,
                            [&](std::span<double> out) { return kinematics_->inverse(pose, tool, seed, out); });
  }
  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    watch_.stateless("jacobian", {{"joints", joints}, {"tool", numbers(tool)}}, jacobian,
                     [&](std::span<double> out) { kinematics_->jacobian(joints, tool, out); });
  }
  bool pole(Vector& axis) const noexcept override {
    return watch_.stateless("pole", {}, {}, [&](std::span<double>) { return kinematics_->pole(axis); });
  }
  std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                        std::span<double> joints) const noexcept override {
    return watch_.stateless("solutions", {{"pose", numbers(pose)}, {"tool", numbers(tool)}, {"seed", seed}}, joints,
                            [&](std::span<double> out) { return kinematics_->solutions(pose, tool, seed, out); });
  }
  bool has_pose(std::span<const double> joints) const noexcept override {
    return watch_.stateless("has_pose", {{"joints", joints}}, {},
                            [&](std::span<double>) { return kinematics_->has_pose(joints); });
  }
  bool parallel() const noexcept override { return kinematics_->parallel(); }
  std::optional<std::size_t> free_joint() const noexcept override { return kinematics_->free_joint(); }
  bool takes(const Frame& tool) const noexcept override {
    return watch_.stateless("takes", {{"tool", numbers(tool)}}, {},
                            [&](std::span<double>) { return kinematics_->takes(tool); });
  }
  bool constant_jacobian() const noexcept override { return kinematics_->constant_jacobian(); }

 private:
  static std::array<double, 7> numbers(const Frame& frame) noexcept {
    return {frame.p[0], frame.p[1], frame.p[2], frame.q[0], frame.q[1], frame.q[2], frame.q[3]};
  }
  static std::array<double, 6> numbers(const ToolPose& pose) noexcept {
    return {pose.tip[0], pose.tip[1], pose.tip[2], pose.axis[0], pose.axis[1], pose.axis[2]};
  }

  std::shared_ptr<const Kinematics> kinematics_;
  Watch& watch_;
};

class WatchedActuatorMap final : public ActuatorMap {
 public:
  WatchedActuatorMap(std::shared_ptr<const ActuatorMap> map, Watch& watch) : map_(std::move(map)), watch_(watch) {}
  std::size_t joint_count() const noexcept override { return map_->joint_count(); }
  std::size_t actuator_count() const noexcept override { return map_->actuator_count(); }
  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    watch_.stateless("actuator_positions", {{"joints", joints}}, actuators,
                     [&](std::span<double> out) { map_->actuator_positions(joints, out); });
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    watch_.stateless("joint_positions", {{"actuators", actuators}}, joints,
                     [&](std::span<double> out) { map_->joint_positions(actuators, out); });
  }
  void joint_velocities(std::span<const double> actuators, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    watch_.stateless("joint_velocities", {{"actuators", actuators}, {"velocities", actuator_velocities}},
                     joint_velocities,
                     [&](std::span<double> out) { map_->joint_velocities(actuators, actuator_velocities, out); });
  }
  void actuator_efforts(std::span<const double> joints, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    watch_.stateless("actuator_efforts", {{"joints", joints}, {"efforts", joint_efforts}}, actuator_efforts,
                     [&](std::span<double> out) { map_->actuator_efforts(joints, joint_efforts, out); });
  }

 private:
  std::shared_ptr<const ActuatorMap> map_;
  Watch& watch_;
};

class WatchedServoLaw final : public ServoLaw {
 public:
  WatchedServoLaw(std::shared_ptr<ServoLaw> law, Watch& watch) : law_(std::move(law)), watch_(watch) {}
  std::span<const GainInfo> gains() const noexcept override { return law_->gains(); }
  bool set_gains(std::span<const double> values) noexcept override {
    watch_.step("set_gains");
    return law_->set_gains(values);
  }
  void set_effort_limit(double effort) noexcept override {
    watch_.step("set_effort_limit");
    law_->set_effort_limit(effort);
  }
  double resting_effort() const noexcept override {
    return watch_.on_cycle("resting_effort", {}, [&] { return law_->resting_effort(); });
  }
  void engage(const ServoInput& input, double effort) noexcept override {
    watch_.on_cycle("engage", {{"input", numbers(input)}, {"effort", {&effort, 1}}},
                    [&] { law_->engage(input, effort); });
  }
  double update(const ServoInput& input) noexcept override {
    return watch_.on_cycle("update", {{"input", numbers(input)}}, [&] { return law_->update(input); });
  }

 private:
  static std::array<double, 8> numbers(const ServoInput& input) noexcept {
    return {input.position_setpoint,
            input.velocity_setpoint,
            input.acceleration_setpoint,
            input.position,
            input.velocity,
            input.effort,
            input.effort_measured ? 1.0 : 0.0,
            input.period_s};
  }

  std::shared_ptr<ServoLaw> law_;
  Watch& watch_;
};

}  // namespace rmac::verifier
