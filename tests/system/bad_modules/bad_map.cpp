#include <algorithm>

#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/sdk/module.hpp"

namespace {

/// Three shafts that turn a radian a millimetre, and feel a thousandth too little.
class BadMap final : public rmac::ActuatorMap {
 public:
  std::size_t joint_count() const noexcept override { return 3; }
  std::size_t actuator_count() const noexcept override { return 3; }
  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    std::copy(joints.begin(), joints.end(), actuators.begin());
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    std::copy(actuators.begin(), actuators.end(), joints.begin());
  }
  void joint_velocities(std::span<const double>, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    std::copy(actuator_velocities.begin(), actuator_velocities.end(), joint_velocities.begin());
  }
  void actuator_efforts(std::span<const double>, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    constexpr double kMetrePerRad = 1e-3, kKept = 0.999;
    for (std::size_t i = 0; i < 3; ++i) actuator_efforts[i] = kKept * kMetrePerRad * joint_efforts[i];
  }
};

struct Factory {
  static rmac::ActuatorMap* create(rmac::sdk::Parameters, char*, std::size_t) { return new BadMap; }
};

}  // namespace

RMAC_MODULE(ActuatorMap, "BadMap", rmac::ActuatorMap, Factory)
