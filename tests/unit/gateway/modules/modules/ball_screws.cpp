#include <cstdio>
#include <numbers>

#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/sdk/module.hpp"

#ifndef TEST_NAME
#define TEST_NAME "TestMap"
#endif
#ifndef TEST_PITCH_MM
#define TEST_PITCH_MM 5
#endif

namespace {

constexpr double kPitchMm = TEST_PITCH_MM;
constexpr double kMmPerRad = kPitchMm / (2 * std::numbers::pi);

/// One ball screw a joint; the parameter `joints` says how many, where the build does not.
class BallScrews final : public rmac::ActuatorMap {
 public:
  explicit BallScrews(std::size_t joints) : joints_(joints) {}
  std::size_t joint_count() const noexcept override { return joints_; }
  std::size_t actuator_count() const noexcept override { return joints_; }
  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    for (std::size_t i = 0; i < joints_; ++i) actuators[i] = joints[i] / kMmPerRad;
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    for (std::size_t i = 0; i < joints_; ++i) joints[i] = actuators[i] * kMmPerRad;
  }
  void joint_velocities(std::span<const double>, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    for (std::size_t i = 0; i < joints_; ++i) joint_velocities[i] = actuator_velocities[i] * kMmPerRad;
  }
  void actuator_efforts(std::span<const double>, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    constexpr double kMPerRad = kMmPerRad / 1000;
    for (std::size_t i = 0; i < joints_; ++i) actuator_efforts[i] = joint_efforts[i] * kMPerRad;
  }

 private:
  std::size_t joints_;
};

struct Factory {
  static rmac::ActuatorMap* create(rmac::sdk::Parameters parameters, char* error, std::size_t size) {
#ifdef TEST_JOINTS
    (void)parameters, (void)error, (void)size;
    return new BallScrews(TEST_JOINTS);
#else
    const auto joints = rmac::sdk::find_numbers(parameters, "joints");
    if (joints.size() != 1 || !(joints[0] >= 1)) {
      std::snprintf(error, size, "joints must be 1 or more");
      return nullptr;
    }
    return new BallScrews(static_cast<std::size_t>(joints[0]));
#endif
  }
};

}  // namespace

RMAC_MODULE(ActuatorMap, TEST_NAME, rmac::ActuatorMap, Factory)
