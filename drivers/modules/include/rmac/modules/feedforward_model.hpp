#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// What the axis needs to follow its setpoint, as far as that is known beforehand:
///
///     effort = Kv·v + Ka·a + Fc·tanh((v + a·lead) / friction_speed) + load
///
/// with v and a the wanted velocity and acceleration. Of the setpoint alone, so nothing here can make a loop unstable.
/// Sliding friction changes its sign where the velocity does. A torque acts some time after it was worked out (a cycle
/// to the drive, half a cycle of hold, the current loop); `lead` is that time, by which the sign is changed earlier.
class FeedforwardModel {
 public:
  struct Parameters {
    double lead_s = 0;
    double friction_speed = 0.5;  ///< mm/s or deg/s; the change of sign is spread over about this much
  };
  static constexpr std::array<GainInfo, 4> kGains{
      {{"Kv", "N·s/mm"}, {"Ka", "N·s²/mm"}, {"Friction", "N"}, {"Load", "N"}}};

  explicit FeedforwardModel(const Parameters& parameters) noexcept : parameters_(parameters) {}

  /// Kv, Ka and friction at least 0; a load of either sign.
  [[nodiscard]] static bool takes(std::span<const double, 4> gains) noexcept {
    return std::all_of(gains.begin(), gains.end(), [](double v) { return std::isfinite(v); }) &&
           std::all_of(gains.begin(), gains.begin() + 3, [](double v) { return v >= 0; });
  }
  void set_gains(std::span<const double, 4> gains) noexcept { std::copy(gains.begin(), gains.end(), gains_.begin()); }

  [[nodiscard]] double load() const noexcept { return gains_[3]; }
  [[nodiscard]] double effort(const ServoInput& input) const noexcept {
    const double v = input.velocity_setpoint;
    const double a = input.acceleration_setpoint;
    const double sign = std::tanh((v + a * parameters_.lead_s) / parameters_.friction_speed);
    return gains_[0] * v + gains_[1] * a + gains_[2] * sign + gains_[3];
  }

  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error,
                                 std::size_t error_size) noexcept {
    const Parameters defaults;
    return sdk::read_number(given, {"lead_s", defaults.lead_s, 0, 0.02, "s"}, parameters.lead_s, error, error_size) &&
           sdk::read_number(given, {"friction_speed", defaults.friction_speed, 1e-3, 100, "mm/s or deg/s"},
                            parameters.friction_speed, error, error_size);
  }

 private:
  Parameters parameters_;
  std::array<double, 4> gains_{};
};

}  // namespace rmac::modules
