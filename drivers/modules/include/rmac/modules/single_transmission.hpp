#pragma once

#include <numbers>

#include "rmac/motion/ports/actuator_map.hpp"

namespace rmac::modules {

inline constexpr double kRadPerDegree = std::numbers::pi / 180;

/// One joint, one motor. What there is to know of it is how the shaft turns with the joint; velocities and efforts
/// follow from the slope of that, efforts by virtual work: torque · dshaft = effort · djoint.
class SingleTransmission : public ActuatorMap {
 public:
  enum class JointUnit { Millimetre, Degree };

  [[nodiscard]] std::size_t joint_count() const noexcept final { return 1; }
  [[nodiscard]] std::size_t actuator_count() const noexcept final { return 1; }

  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept final {
    actuators[0] = shaft(joints[0]);
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept final {
    joints[0] = joint(actuators[0]);
  }
  void joint_velocities(std::span<const double> actuators, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept final {
    joint_velocities[0] = actuator_velocities[0] / slope(joint(actuators[0]));
  }
  void actuator_efforts(std::span<const double> joints, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept final {
    actuator_efforts[0] = joint_efforts[0] * work_per_unit_ / slope(joints[0]);
  }

 protected:
  explicit SingleTransmission(JointUnit unit) noexcept
      : work_per_unit_(unit == JointUnit::Degree ? kRadPerDegree : 1e-3) {}

 private:
  [[nodiscard]] virtual double shaft(double joint) const noexcept = 0;  ///< rad
  [[nodiscard]] virtual double joint(double shaft) const noexcept = 0;  ///< mm or deg
  [[nodiscard]] virtual double slope(double joint) const noexcept = 0;  ///< d shaft / d joint; never 0

  double work_per_unit_;  ///< joules in an effort of 1 over a way of 1
};

}  // namespace rmac::modules
