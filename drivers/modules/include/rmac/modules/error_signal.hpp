#pragma once

#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::modules {

/// Following error of one joint, and its rate behind a first-order low-pass. The rate is the difference of wanted and
/// measured velocity, so that a setpoint's jump in position does not appear in it.
class ErrorSignal {
 public:
  explicit ErrorSignal(double filter_s) noexcept : filter_s_(filter_s) {}

  void engage(const ServoInput& input) noexcept {
    error_ = input.position_setpoint - input.position;
    rate_ = input.velocity_setpoint - input.velocity;
  }
  void update(const ServoInput& input) noexcept {
    error_ = input.position_setpoint - input.position;
    const double rate = input.velocity_setpoint - input.velocity;
    rate_ += (rate - rate_) * (input.period_s / (input.period_s + filter_s_));
  }
  [[nodiscard]] double error() const noexcept { return error_; }
  [[nodiscard]] double rate() const noexcept { return rate_; }

 private:
  double filter_s_;
  double error_ = 0;  ///< mm or deg
  double rate_ = 0;   ///< mm/s or deg/s, filtered
};

}  // namespace rmac::modules
