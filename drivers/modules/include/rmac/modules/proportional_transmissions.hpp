#pragma once

#include <numbers>

#include "rmac/modules/single_transmission.hpp"

namespace rmac::modules {

/// A joint whose motor turns in proportion to it: a screw or rack (mm), a gear (degrees).
class Proportional final : public SingleTransmission {
 public:
  /// Ball screw, rack, or the screw joint itself (which turns about the axis along which it slides; it counts mm):
  /// `lead_mm` a turn, `gear` motor turns a turn.
  [[nodiscard]] static Proportional screw(double lead_mm, double gear) noexcept {
    return {JointUnit::Millimetre, 2 * std::numbers::pi * gear / lead_mm};
  }
  /// `gear` motor turns a turn of the joint.
  [[nodiscard]] static Proportional gear(double gear) noexcept { return {JointUnit::Degree, gear * kRadPerDegree}; }

 private:
  Proportional(JointUnit unit, double slope) noexcept : SingleTransmission(unit), slope_(slope) {}
  [[nodiscard]] double shaft(double joint) const noexcept override { return slope_ * joint; }
  [[nodiscard]] double joint(double shaft) const noexcept override { return shaft / slope_; }
  [[nodiscard]] double slope(double /*joint*/) const noexcept override { return slope_; }

  double slope_;  ///< rad a mm or degree
};

/// A gantry: two screws side by side move one joint, and each takes half the load. The joint stands where their mean
/// stands; the bridge, and the joint's `Gantry`, keep them in step.
class GantryPair final : public ActuatorMap {
 public:
  GantryPair(double lead_mm, double gear) noexcept : rad_per_mm_(2 * std::numbers::pi * gear / lead_mm) {}

  [[nodiscard]] std::size_t joint_count() const noexcept override { return 1; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 2; }

  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    actuators[0] = actuators[1] = joints[0] * rad_per_mm_;
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    joints[0] = (actuators[0] + actuators[1]) / (2 * rad_per_mm_);
  }
  void joint_velocities(std::span<const double> /*actuators*/, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    joint_positions(actuator_velocities, joint_velocities);
  }
  void actuator_efforts(std::span<const double> /*joints*/, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    actuator_efforts[0] = actuator_efforts[1] = joint_efforts[0] * 1e-3 / (2 * rad_per_mm_);
  }

 private:
  double rad_per_mm_;
};

/// Two motors that move two joints together: both the same way the first, against each other the second. Bevel wrists
/// (degrees), crossed belts (mm).
class DifferentialPair final : public ActuatorMap {
 public:
  /// `gear`: motor turns a turn of each joint.
  [[nodiscard]] static DifferentialPair rotary(double gear1, double gear2) noexcept {
    return {{gear1 * kRadPerDegree, gear2 * kRadPerDegree}, kRadPerDegree};
  }
  /// `lead_mm`: mm of each joint a turn of the motors.
  [[nodiscard]] static DifferentialPair linear(double lead1_mm, double lead2_mm) noexcept {
    return {{2 * std::numbers::pi / lead1_mm, 2 * std::numbers::pi / lead2_mm}, 1e-3};
  }

  [[nodiscard]] std::size_t joint_count() const noexcept override { return 2; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return 2; }

  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    const double same = slope_[0] * joints[0];
    const double against = slope_[1] * joints[1];
    actuators[0] = same + against;
    actuators[1] = same - against;
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    joints[0] = (actuators[0] + actuators[1]) / (2 * slope_[0]);
    joints[1] = (actuators[0] - actuators[1]) / (2 * slope_[1]);
  }
  void joint_velocities(std::span<const double> /*actuators*/, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    joint_positions(actuator_velocities, joint_velocities);
  }
  void actuator_efforts(std::span<const double> /*joints*/, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    const double same = joint_efforts[0] * work_per_unit_ / (2 * slope_[0]);
    const double against = joint_efforts[1] * work_per_unit_ / (2 * slope_[1]);
    actuator_efforts[0] = same + against;
    actuator_efforts[1] = same - against;
  }

 private:
  struct Slopes {
    double first, second;
  };
  DifferentialPair(Slopes slopes, double work_per_unit) noexcept
      : slope_{slopes.first, slopes.second}, work_per_unit_(work_per_unit) {}

  double slope_[2];  ///< rad a mm or degree
  double work_per_unit_;
};

}  // namespace rmac::modules
