#pragma once

#include <cmath>
#include <numbers>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// A sine whose frequency goes from one end of a band to the other at a steady rate, and again with the other sign,
/// while a joint goes at a steady speed: there its friction slides one way, and what is left between effort and motion
/// is linear. Each steady stretch begins anew, so many times and no more; one that ends before its periods are through
/// is the last, and so is it when none begins within a minute: whoever wanted it may be gone. What is the same in two
/// periods (cogging at that speed, drift, answers that are even in the effort) falls out of their difference, and the
/// mean of many shows what answers the sine apart from noise (Pintelon and Schoukens, System Identification, 2nd ed.,
/// section 5.2).
class SweptSine {
 public:
  struct Parameters {
    double effort = 0;  ///< amplitude, N or N·m; 0: none
    double from_hz = 0;
    double to_hz = 0;
    double full_hz = 0;  ///< below it the amplitude is less in proportion, so that the joint does not turn round
    double period_s = 0;
    double periods = 0;    ///< of each steady stretch, whole ones
    double stretches = 0;  ///< after which there is none any more
  };
  explicit SweptSine(const Parameters& parameters) noexcept
      : parameters_(parameters), stretches_left_(static_cast<long>(parameters.stretches)) {}

  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error,
                                 std::size_t error_size) noexcept {
    const auto number = [&](const sdk::NumberParameter& wanted, double& value) {
      return sdk::read_number(given, wanted, value, error, error_size);
    };
    return number({"sweep_effort", 0, 0, 1e7, "N or N·m"}, parameters.effort) &&
           number({"sweep_from_hz", 10, 0.1, 10000, "Hz"}, parameters.from_hz) &&
           number({"sweep_to_hz", 450, 0.1, 10000, "Hz"}, parameters.to_hz) &&
           number({"sweep_full_hz", 0, 0, 10000, "Hz"}, parameters.full_hz) &&
           number({"sweep_period_s", 0.5, 0.01, 100, "s"}, parameters.period_s) &&
           number({"sweep_periods", 5, 1, 1000, ""}, parameters.periods) &&
           number({"sweep_stretches", 2, 1, 1000, ""}, parameters.stretches);
  }

  /// Effort of this cycle. Real-time safe.
  [[nodiscard]] double step(const ServoInput& input) noexcept {
    constexpr long kFlicker = 10;  // cycles: where a ramp ends, its rounding may look steady
    constexpr double kPatience_s = 60;
    const bool through = done_ >= static_cast<long>(parameters_.periods);
    if (!is_steady(input)) {
      if (through) {
        --stretches_left_;
      } else if (cycle_ > kFlicker || done_ > 0) {
        stretches_left_ = 0;
      }
      cycle_ = 0;
      done_ = 0;
      waited_s_ += input.period_s;
      if (waited_s_ > kPatience_s) stretches_left_ = 0;
      return 0;
    }
    if (through || stretches_left_ <= 0) return 0;
    waited_s_ = 0;
    const double t = static_cast<double>(cycle_) * input.period_s;
    const double rate = (parameters_.to_hz - parameters_.from_hz) / parameters_.period_s;
    const double hz = parameters_.from_hz + rate * t;
    const double share = hz < parameters_.full_hz ? hz / parameters_.full_hz : 1;
    const double turns = t * (parameters_.from_hz + 0.5 * rate * t);
    const double sign = done_ % 2 == 0 ? 1 : -1;
    if (++cycle_ >= std::lround(parameters_.period_s / input.period_s)) {
      cycle_ = 0;
      ++done_;
    }
    return sign * share * parameters_.effort * std::sin(2 * std::numbers::pi * turns);
  }

 private:
  /// Moving, and by less than a thousandth faster or slower in this cycle than in the last.
  [[nodiscard]] static bool is_steady(const ServoInput& input) noexcept {
    const double speed = std::abs(input.velocity_setpoint);
    return speed > 1e-6 && std::abs(input.acceleration_setpoint) * input.period_s <= 1e-3 * speed;
  }

  Parameters parameters_;
  long cycle_ = 0;  ///< of this period
  long done_ = 0;   ///< periods of this stretch
  long stretches_left_;
  double waited_s_ = 0;  ///< for a stretch to begin
};

}  // namespace rmac::modules
