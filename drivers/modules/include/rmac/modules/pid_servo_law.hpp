#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "rmac/motion/ports/servo_law.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::modules {

/// PID law of one joint: effort = Kp·e + Kd·ė + Ki·∫e, with e the following error, and ė the difference of wanted and
/// measured velocity behind a first-order low-pass. Gains act at the joint: N/mm, N/(mm·s), N·s/mm for a linear one,
/// N·m and deg for a rotary one.
///
/// The integral stands still while the output is at its limit and the error would drive it further (conditional
/// integration), so it does not wind up. Engaging and new gains set the integral so that the output does not jump.
class PidServoLaw final : public ServoLaw {
 public:
  explicit PidServoLaw(double derivative_filter_s) noexcept : derivative_filter_s_(derivative_filter_s) {}

  [[nodiscard]] std::span<const GainInfo> gains() const noexcept override { return kGains; }

  [[nodiscard]] bool set_gains(std::span<const double> values) noexcept override {
    if (values.size() != kGains.size()) return false;
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v) && v >= 0; })) return false;
    if (values[0] == 0) return false;
    integral_ += (kp_ - values[0]) * error_ + (kd_ - values[2]) * error_rate_;
    kp_ = values[0];
    ki_ = values[1];
    kd_ = values[2];
    return true;
  }

  void set_effort_limit(double effort) noexcept override { limit_ = std::abs(effort); }

  void engage(const ServoInput& input, double effort) noexcept override {
    error_ = input.position_setpoint - input.position;
    error_rate_ = input.velocity_setpoint - input.velocity;
    // The next update integrates once before its output.
    integral_ = std::clamp(effort, -limit_, limit_) - kp_ * error_ - kd_ * error_rate_ - ki_ * error_ * input.period_s;
  }

  [[nodiscard]] double update(const ServoInput& input) noexcept override {
    const double error = input.position_setpoint - input.position;
    const double rate = input.velocity_setpoint - input.velocity;
    if (!std::isfinite(error) || !std::isfinite(rate)) return error + rate;  // NaN or infinity; the state stays sound
    error_ = error;
    error_rate_ += (rate - error_rate_) * (input.period_s / (input.period_s + derivative_filter_s_));

    const double proportional = kp_ * error_ + kd_ * error_rate_;
    const double grown = integral_ + ki_ * error_ * input.period_s;
    const double output = proportional + grown;
    const bool winds_up = std::abs(output) > limit_ && output * error_ > 0;
    if (!winds_up) integral_ = grown;
    return std::clamp(output, -limit_, limit_);
  }

 private:
  static constexpr std::array<GainInfo, 3> kGains{{{"Kp", "N/mm"}, {"Ki", "N/(mm·s)"}, {"Kd", "N·s/mm"}}};

  double derivative_filter_s_;
  double kp_ = 0, ki_ = 0, kd_ = 0;
  double limit_ = 0;
  double integral_ = 0;    ///< effort
  double error_ = 0;       ///< of the last cycle
  double error_rate_ = 0;  ///< filtered
};

/// Makes a `PidServoLaw`; the parameter `derivative_filter_s` is the time constant of its low-pass, 0 (none) unless
/// given.
struct PidServoLawFactory {
  static ServoLaw* create(sdk::Parameters parameters, char* error, std::size_t error_size) noexcept {
    const std::span<const double> filter = sdk::find_numbers(parameters, "derivative_filter_s");
    const double filter_s = filter.empty() ? 0 : filter[0];
    if (filter.size() > 1 || !std::isfinite(filter_s) || filter_s < 0 || filter_s > 0.1) {
      std::snprintf(error, error_size, "parameter derivative_filter_s must be one number from 0 to 0.1 s");
      return nullptr;
    }
    return new PidServoLaw(filter_s);
  }
};

}  // namespace rmac::modules
