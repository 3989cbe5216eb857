#pragma once

#include <memory>
#include <vector>

#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// Transmissions side by side: the first has the first joints and actuators, and so on.
class TransmissionMap final : public ActuatorMap {
 public:
  explicit TransmissionMap(std::vector<std::unique_ptr<ActuatorMap>> transmissions) {
    for (std::unique_ptr<ActuatorMap>& transmission : transmissions) {
      const ActuatorMap& map = *transmission;
      parts_.push_back({std::move(transmission), joints_, map.joint_count(), actuators_, map.actuator_count()});
      joints_ += map.joint_count();
      actuators_ += map.actuator_count();
    }
  }

  [[nodiscard]] std::size_t joint_count() const noexcept override { return joints_; }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return actuators_; }

  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    for (const Part& part : parts_) part.map->actuator_positions(part.joints(joints), part.actuators(actuators));
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    for (const Part& part : parts_) part.map->joint_positions(part.actuators(actuators), part.joints(joints));
  }
  void joint_velocities(std::span<const double> actuators, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    for (const Part& part : parts_) {
      part.map->joint_velocities(part.actuators(actuators), part.actuators(actuator_velocities),
                                 part.joints(joint_velocities));
    }
  }
  void actuator_efforts(std::span<const double> joints, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    for (const Part& part : parts_) {
      part.map->actuator_efforts(part.joints(joints), part.joints(joint_efforts), part.actuators(actuator_efforts));
    }
  }

 private:
  struct Part {
    std::unique_ptr<ActuatorMap> map;
    std::size_t first_joint, joint_count, first_actuator, actuator_count;
    template <typename T>
    [[nodiscard]] std::span<T> joints(std::span<T> all) const noexcept {
      return all.subspan(first_joint, joint_count);
    }
    template <typename T>
    [[nodiscard]] std::span<T> actuators(std::span<T> all) const noexcept {
      return all.subspan(first_actuator, actuator_count);
    }
  };
  std::vector<Part> parts_;
  std::size_t joints_ = 0, actuators_ = 0;
};

/// Makes a `TransmissionMap`. Parameter `transmissions` names them in the order of the joints, parted by blanks; the
/// numbers of the first are in parameter `t1`, of the second in `t2`, and so on. README.md lists names and numbers.
struct TransmissionMapFactory {
  static ActuatorMap* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept;
};

}  // namespace rmac::modules
