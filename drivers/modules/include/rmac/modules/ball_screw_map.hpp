#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <vector>

#include "rmac/motion/ports/actuator_map.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// One motor a joint, through a gear and a ball screw: shaft angle = 2π · gear_ratio / pitch · joint.
class BallScrewMap final : public ActuatorMap {
 public:
  /// `pitch_mm` a turn of the screw, `gear_ratio` motor turns a turn of the screw; one of each a joint, above 0.
  BallScrewMap(std::span<const double> pitch_mm, std::span<const double> gear_ratio) {
    for (std::size_t i = 0; i < pitch_mm.size(); ++i) {
      rad_per_mm_.push_back(2 * std::numbers::pi * gear_ratio[i] / pitch_mm[i]);
    }
  }

  [[nodiscard]] std::size_t joint_count() const noexcept override { return rad_per_mm_.size(); }
  [[nodiscard]] std::size_t actuator_count() const noexcept override { return rad_per_mm_.size(); }

  void actuator_positions(std::span<const double> joints, std::span<double> actuators) const noexcept override {
    for (std::size_t i = 0; i < rad_per_mm_.size(); ++i) actuators[i] = joints[i] * rad_per_mm_[i];
  }
  void joint_positions(std::span<const double> actuators, std::span<double> joints) const noexcept override {
    for (std::size_t i = 0; i < rad_per_mm_.size(); ++i) joints[i] = actuators[i] / rad_per_mm_[i];
  }
  void joint_velocities(std::span<const double> /*actuators*/, std::span<const double> actuator_velocities,
                        std::span<double> joint_velocities) const noexcept override {
    joint_positions(actuator_velocities, joint_velocities);
  }
  void actuator_efforts(std::span<const double> /*joints*/, std::span<const double> joint_efforts,
                        std::span<double> actuator_efforts) const noexcept override {
    // N times mm a radian is N·mm, a thousandth of the N·m that the shaft has.
    for (std::size_t i = 0; i < rad_per_mm_.size(); ++i) {
      actuator_efforts[i] = joint_efforts[i] / (rad_per_mm_[i] * 1000);
    }
  }

 private:
  std::vector<double> rad_per_mm_;
};

/// Makes a `BallScrewMap` of `kJoints` joints from the parameters `pitch_mm` and `gear_ratio`.
template <std::size_t kJoints>
struct BallScrewMapFactory {
  static ActuatorMap* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    const std::span<const double> pitch = sdk::find_numbers(parameters, "pitch_mm");
    const std::span<const double> gear = sdk::find_numbers(parameters, "gear_ratio");
    if (!check("pitch_mm", pitch, error, error_size) || !check("gear_ratio", gear, error, error_size)) return nullptr;
    return new BallScrewMap(pitch, gear);
  }

 private:
  static bool check(const char* name, std::span<const double> values, char* error, std::size_t error_size) noexcept {
    if (values.size() != kJoints) {
      std::snprintf(error, error_size, "parameter %s has %zu values; give %zu, one a joint", name, values.size(),
                    kJoints);
      return false;
    }
    for (const double value : values) {
      if (std::isfinite(value) && value > 0) continue;
      std::snprintf(error, error_size, "parameter %s holds %g; it must be above 0", name, value);
      return false;
    }
    return true;
  }
};

}  // namespace rmac::modules
