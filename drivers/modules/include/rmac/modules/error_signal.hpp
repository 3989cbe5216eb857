#pragma once

#include <cmath>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/parameters.hpp"

namespace rmac::modules {

/// Following error of one joint, and its rate behind a first-order low-pass. The rate is the difference of wanted and
/// measured velocity, so that a setpoint's jump in position does not appear in it.
class ErrorSignal {
 public:
  struct Parameters {
    double filter_s = 0;   ///< `derivative_filter_s`
    double rest_band = 0;  ///< mm or deg
  };
  explicit ErrorSignal(const Parameters& parameters) noexcept : parameters_(parameters) {}

  /// The parameters of every law with a D and an I term; none of them unless given.
  [[nodiscard]] static bool read(sdk::Parameters given, Parameters& parameters, char* error,
                                 std::size_t error_size) noexcept {
    return sdk::read_number(given, {"derivative_filter_s", 0, 0, 0.1, "s"}, parameters.filter_s, error, error_size) &&
           sdk::read_number(given, {"rest_band", 0, 0, 1, "mm or deg"}, parameters.rest_band, error, error_size);
  }

  void engage(const ServoInput& input) noexcept {
    error_ = input.position_setpoint - input.position;
    rate_ = input.velocity_setpoint - input.velocity;
    look_for_rest(input);
  }
  void update(const ServoInput& input) noexcept {
    error_ = input.position_setpoint - input.position;
    const double rate = input.velocity_setpoint - input.velocity;
    rate_ += (rate - rate_) * (input.period_s / (input.period_s + parameters_.filter_s));
    look_for_rest(input);
  }
  [[nodiscard]] double error() const noexcept { return error_; }
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// The joint is to stand.
  [[nodiscard]] bool stands() const noexcept { return stands_; }
  /// It is to stand, and is as near to where it is to stand as it needs to be: an integral that went on would
  /// push it off against its static friction, and it would hunt.
  [[nodiscard]] bool rests() const noexcept { return rests_; }

 private:
  void look_for_rest(const ServoInput& input) noexcept {
    constexpr double kStanding = 1e-6;  // mm/s, mm/s², or degrees: less is rounding
    stands_ = std::abs(input.velocity_setpoint) <= kStanding && std::abs(input.acceleration_setpoint) <= kStanding;
    rests_ = stands_ && parameters_.rest_band > 0 && std::abs(error_) <= parameters_.rest_band;
  }

  Parameters parameters_;
  double error_ = 0;  ///< mm or deg
  double rate_ = 0;   ///< mm/s or deg/s, filtered
  bool stands_ = false, rests_ = false;
};

}  // namespace rmac::modules
