#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <vector>

#include "rmac/modules/proportional_transmissions.hpp"
#include "rmac/modules/transmission_map.hpp"
#include "rmac/sdk/module.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// Makes a map of `kJoints` ball screws, one motor each, from the parameters `pitch_mm` (a turn of the screw) and
/// `gear_ratio` (motor turns a turn of the screw), one of each a joint.
template <std::size_t kJoints>
struct BallScrewMapFactory {
  static ActuatorMap* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    if (!sdk::are_known_numbers(parameters, {"pitch_mm", "gear_ratio"}, error, error_size)) return nullptr;
    const std::span<const double> pitch = sdk::find_numbers(parameters, "pitch_mm");
    const std::span<const double> gear = sdk::find_numbers(parameters, "gear_ratio");
    if (!check("pitch_mm", pitch, error, error_size) || !check("gear_ratio", gear, error, error_size)) return nullptr;
    std::vector<std::unique_ptr<ActuatorMap>> screws;
    for (std::size_t i = 0; i < kJoints; ++i) {
      screws.push_back(std::make_unique<Proportional>(Proportional::screw(pitch[i], gear[i])));
    }
    return new TransmissionMap(std::move(screws));
  }

 private:
  /// Bounds of mm a turn, and of motor turns a turn of the screw: far beyond what is built.
  static constexpr double kLeast = 1e-3;
  static constexpr double kMost = 1e4;

  static bool check(const char* name, std::span<const double> values, char* error, std::size_t error_size) noexcept {
    if (values.size() != kJoints) {
      std::snprintf(error, error_size, "parameter %s has %zu values; give %zu, one a joint", name, values.size(),
                    kJoints);
      return false;
    }
    for (const double value : values) {
      if (value >= kLeast && value <= kMost) continue;
      std::snprintf(error, error_size, "parameter %s holds %g; it must be %g to %g", name, value, kLeast, kMost);
      return false;
    }
    return true;
  }
};

}  // namespace rmac::modules
